import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";

import { fits, launch, open, picture, stumbles } from "./browser.js";
import { Service, command } from "./service.js";

const VIEWS = ["story", "live", "compare", "failures", "effects", "posterior", "errors", "trust"];

let service;
let browser;
before(async () => {
  service = await Service.start();
  browser = await launch();
  for (const job of ["examples/hidden-effect/job.toml", "examples/cmu-sand/discover.toml"]) command(["submit", job, "--url", service.url]);
  for (const study of [1, 2]) {
    for (let look = 0; (await service.json(`/v1/studies/${study}`)).state !== "finished"; look += 1) {
      assert.ok(look < 600, "the study ends within two minutes");
      await new Promise((resolve) => setTimeout(resolve, 200));
    }
  }
});
after(async () => {
  await browser.close();
  await service.stop();
});

for (const [width, theme] of [[1280, "light"], [400, "dark"]]) {
  test(`every view has good manners at ${width} px, ${theme}`, async () => {
    const { page, complaints } = await open(browser, service.url, { width, theme });
    const places = ["#/", "#/new", ...[1, 2].flatMap((study) => VIEWS.map((view) => `#/studies/${study}/${view}`))];
    for (const place of places) {
      await page.goto(service.url + place);
      await page.waitForFunction(() => !document.querySelector("[aria-busy]") && document.querySelector("main")?.textContent);
      await page.waitForTimeout(250);
      const name = place.replace(/[#/]+/g, "-").replace(/^-/, "") || "home";
      await picture(page, `${name}-${width}-${theme}`);
      assert.deepEqual(await stumbles(page), [], place);
      await fits(page, place);
    }
    assert.deepEqual(complaints, []);
  });
}

test("an explanation shows what it would change to the keyboard, too", async () => {
  const { page } = await open(browser, `${service.url}#/studies/1/effects?model=1`);
  const explanation = page.getByRole("button", { name: "janosi_hanamoto", exact: true });
  await explanation.focus();
  await page.locator(".ghosts .ghost").first().waitFor({ state: "attached" });
});

test("a picture is saved as SVG, PNG and CSV", async () => {
  const { page } = await open(browser, `${service.url}#/studies/1/compare`);
  const figure = page.locator('[data-figure*="drawbar-pull"]').first();
  await figure.locator(".plot svg").first().waitFor();
  for (const [button, begins] of [["SVG", "<svg"], ["PNG", "\x89PNG"], ["CSV", "model,run"]]) {
    const waiting = page.waitForEvent("download");
    await figure.getByRole("button", { name: button, exact: true }).click();
    const saved = readFileSync(await (await waiting).path(), "latin1");
    assert.ok(saved.startsWith(begins) && saved.length > 1000, `${button}: ${saved.slice(0, 40)}`);
  }
});

test("the first view of a study takes less than 300 kB", async () => {
  const { page } = await open(browser, "about:blank");
  const session = await page.context().newCDPSession(page);
  await session.send("Network.enable");
  let bytes = 0;
  session.on("Network.loadingFinished", (event) => (bytes += event.encodedDataLength));
  await page.goto(`${service.url}#/studies/1/compare`);
  await page.locator('[data-figure*="sinkage"] svg').first().waitFor();
  assert.ok(bytes > 50_000 && bytes < 300_000, `${bytes} bytes`);
});

test("a service with tokens asks for one, and keeps it out of addresses", async () => {
  const secret = command(["token", "add", "reader", "--role", "read", "--store", service.store]).match(/\S{20,}/)[0];
  await new Promise((resolve) => setTimeout(resolve, 1500));
  const { page } = await open(browser, service.url);
  const addresses = [];
  page.on("request", (request) => addresses.push(request.url()));
  await page.getByLabel("Token").fill(secret);
  await page.getByRole("button", { name: "Use it" }).click();
  await page.getByText("hidden-effect").first().waitFor();
  assert.ok(addresses.length > 0 && addresses.every((address) => !address.includes(secret)));
});
