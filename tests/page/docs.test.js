// The description of the interface in a browser: everything that openapi.json says, readable, and what reads can be tried.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { findings, open, shot, sideways } from "./browser.js";
import { Service } from "./service.js";

let service;

before(async () => {
  service = await Service.start();
});
after(() => service?.stop());

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 1280],
  ["light", 400],
  ["dark", 400],
]) {
  test(`the interface is described, accessible and fits, ${theme}, ${width} px`, async () => {
    const tab = await open({ url: service.url, theme, width });
    try {
      const { page } = tab;
      await page.goto(`${service.url}/docs`);
      await page.getByRole("heading", { name: "The interface" }).waitFor();
      const { paths, components } = await service.get("/openapi.json");
      const ids = Object.values(paths).flatMap((methods) =>
        Object.values(methods).map(({ operationId }) => operationId),
      );
      await page.locator(".operation").first().waitFor();
      assert.deepEqual(
        (await page.locator(".operation").evaluateAll((all) => all.map(({ id }) => id))).sort(),
        ids.sort(),
      );
      assert.equal(await page.locator(".schema").count(), Object.keys(components.schemas).length);
      await shot(page, `docs-${theme}-${width}`);

      await page.goto(`${service.url}/docs#/create_experiment`);
      await page.locator("#create_experiment pre").first().waitFor();
      await shot(page, `docs-post-${theme}-${width}`);

      await page.goto(`${service.url}/docs#/get_example`);
      const operation = page.locator("#get_example");
      await operation.getByLabel("name").fill("hidden-effect");
      await operation.getByRole("button", { name: "GET" }).click();
      await operation.getByRole("status").getByText("200 after").waitFor();
      assert.match(await operation.locator(".answer").textContent(), /"experiment.toml"/);
      assert.match(
        await operation.getByLabel("the same on a terminal").textContent(),
        /^curl -s 'http:.*\/v1\/examples\/hidden-effect'$/,
      );
      assert.deepEqual(await findings(page), []);
      assert.equal(await sideways(page), 0, "it scrolls sideways [px]");
      await shot(page, `docs-trial-${theme}-${width}`);

      await operation.getByLabel("name").fill("nothing");
      await operation.getByRole("button", { name: "GET" }).click();
      await operation.getByRole("alert").getByText('there is no example "nothing"').waitFor();

      await page.locator("#create_calibration > summary").click();
      await page.locator("#create_calibration").getByRole("link", { name: "NewCalibration" }).click();
      await page.locator("#schemas\\/NewCalibration").getByText("Text of job.toml").waitFor();
      assert.deepEqual(await findings(page), []);
      assert.deepEqual(tab.faults, []);
    } finally {
      await tab.close();
    }
  });
}
