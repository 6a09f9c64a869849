// What the story and the list of studies say where a study fails, and where the data leave open which effect is missing.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { findings, open, shot, sideways } from "./browser.js";
import { Service, filesOf } from "./service.js";

let service;

/** Submits a folder's job and returns its first calibration and study, once the study is over. */
async function over(folder, edit) {
  const texts = Object.fromEntries((await filesOf(folder, edit)).map(({ name, text }) => [name, text]));
  const { id } = await service.post("/v1/experiments", {
    toml: texts["experiment.toml"],
    files: { "runs.csv": texts["runs.csv"] },
  });
  const created = await service.post("/v1/calibrations", {
    experiment: id,
    toml: texts["job.toml"],
    files: {},
    name: folder.split("/").at(-1),
  });
  await service.finished(created.study);
  return created;
}

before(async () => {
  service = await Service.start();
});
after(() => service?.stop());

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 400],
]) {
  test(`a failed study says why, and what to do, ${theme}, ${width} px`, async () => {
    // A soil like water carries no wheel.
    const { study } = await over("examples/hidden-effect", (job) =>
      job.replace("log10_p_ref = { uniform = [4.0, 5.6] }", "log10_p_ref = { uniform = [1.1, 1.6] }"),
    );
    const tab = await open({ url: service.url, theme, width });
    const { page } = tab;
    try {
      await page.goto(service.url);
      await page.getByText("prior draws were rejected by the model").first().waitFor();
      await page.getByText("check wheel loads, radius and width").first().waitFor();
      await shot(page, `story-failed-home-${theme}`);
      await page.goto(`${service.url}/#/studies/${study}/story`);
      const card = page.getByRole("alert").filter({ hasText: "The calibration failed" });
      await card.waitFor();
      assert.match(
        await card.textContent(),
        /All 1000 prior draws were rejected by the model: the soil does not carry the load \(no_support.*What to do: Check wheel loads/s,
      );
      assert.equal(await page.getByText("Nothing is finished yet").count(), 0);
      // No other view lets people wait for what will not come.
      for (const name of ["compare", "failures", "effects", "posterior", "predict", "decide", "errors", "trust"]) {
        await page.goto(`${service.url}/#/studies/${study}/${name}`);
        await page
          .locator(`section.view.${name}`)
          .getByText("The calibration failed, so that there is nothing to show.")
          .waitFor();
      }
      await page.getByRole("link", { name: "The story" }).click();
      await card.waitFor();
      assert.deepEqual(await findings(page), []);
      assert.equal(await sideways(page), 0);
      await shot(page, `story-failed-${theme}`);
      assert.deepEqual(tab.faults, []);
    } finally {
      await tab.close();
    }
  });
}

test("the rival of an effect that was added stays in story and list, with the run that decides", async () => {
  const { id, study } = await over("tests/data/one-of-a-class");
  await service.post(`/v1/calibrations/${id}/extend`, { effect: "slip_sinkage" });
  const { current } = await service.finished(study);
  const tab = await open({ url: service.url });
  const { page } = tab;
  try {
    await page.goto(service.url);
    await page
      .locator("tr", { hasText: "one-of-a-class" })
      .getByText("slip_softened_pressure (P 0.46) in place of slip_sinkage cannot be excluded")
      .waitFor();
    await page.getByText("nothing further is detectable").first().waitFor();
    await page.goto(`${service.url}/#/studies/${study}/story?model=${id}`);
    assert.match(
      await page.locator(".headline h2").textContent(),
      /\(sinkage of held-out runs: error 1\.10\u00a0mm, noise 0\.60\u00a0mm\)/,
    );
    await page.goto(service.url);
    await shot(page, "story-class-home");
    await page.goto(`${service.url}/#/studies/${study}/story`);
    const bars = page.getByRole("region", { name: "What was found" }).locator(".bars li");
    await bars.first().waitFor();
    assert.deepEqual(await bars.locator(".number").allTextContents(), ["P 0.54", "P 0.46", "P 0.004"]);
    assert.match(await bars.first().textContent(), /the sinkage exponent grows with slip slip_sinkage/);
    const missing = page.locator(".card", { hasText: "What is missing" });
    await missing.waitFor();
    const text = await missing.textContent();
    assert.match(
      text,
      /slip_sinkage \(P\s0\.54\) is added.*slip_softened_pressure \(P\s0\.46\) in place of slip_sinkage cannot be excluded\.\s*Slip 0\.80 under 280\sN/i,
    );
    assert.equal(await page.getByText("It could also be").count(), 0);
    await shot(page, "story-class");
    // The runs are those of the search that left it open, and are added to the model that was searched.
    await page.getByRole("link", { name: "See the runs, and add them" }).first().click();
    await page.getByLabel("slip of run 1").waitFor();
    assert.notEqual(id, current);
    assert.equal(new URLSearchParams(page.url().split("?")[1]).get("model"), String(id));
    assert.equal(await page.getByLabel("slip of run 1").inputValue(), "0.8");
    assert.deepEqual(tab.faults, []);
  } finally {
    await tab.close();
  }
});
