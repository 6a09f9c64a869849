// Several models compared: the report says which one it is, and shows the table.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { findings, open, shot, sideways, studyOf } from "./browser.js";
import { Service, coordinator, filesOf } from "./service.js";

let folder;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "models-"));
  await coordinator("run", "examples/which-model/job.toml", "--out", join(folder, "out"));
});
after(() => rm(folder, { recursive: true, force: true }));

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 400],
]) {
  test(`the chosen model stands first, with what speaks for it, ${theme}, ${width} px`, async () => {
    const url = pathToFileURL(join(folder, "out", "report.html")).href;
    const tab = await open({ url, theme, width });
    const { page } = tab;
    try {
      await page.goto(url);
      await page.locator("section#trust").waitFor();
      const rows = page.getByRole("region", { name: "Which model" }).locator("tbody tr");
      await rows.first().waitFor();
      assert.match(await page.locator(".verdict").first().textContent(), /wong_reece is the most probable of 3 models/);
      assert.deepEqual(await rows.locator("th").allTextContents(), ["wong_reece", "quasi_static", "rft"]);
      assert.match(await rows.first().textContent(), /47\.\d+ ± 0\.\d+> 0\.999.*chosen; predicts best/);
      assert.match(
        await page.locator("header .note").first().textContent(),
        /^wong_reece; compared: quasi_static, wong_reece, rft$/,
      );
      assert.deepEqual(await findings(page), []);
      assert.equal(await sideways(page), 0);
      assert.deepEqual(tab.faults, []);
      await shot(page, `models-${theme}-${width}`);
    } finally {
      await tab.close();
    }
  });
}

test("the particles of a model are drawn in the units that the service states", async () => {
  const service = await Service.start();
  const tab = await open({ url: service.url });
  const { page } = tab;
  try {
    await page.goto(`${service.url}/#/new`);
    const files = await filesOf("examples/which-model", (job) => job, ["job.toml", "experiment.toml", "runs.csv"]);
    await page
      .locator('input[type="file"]')
      .setInputFiles(files.map(({ text, ...file }) => ({ ...file, buffer: Buffer.from(text) })));
    await page
      .locator(".card.file")
      .nth(files.length - 1)
      .waitFor();
    await page.getByRole("button", { name: "Start the calibration" }).click();
    await page.waitForURL(/live/);
    const study = await service.finished(studyOf(page));
    const samples = await Promise.all(study.members.map((m) => service.get(`/v1/calibrations/${m.id}/samples?most=1`)));
    const rft = study.members[samples.findIndex((s) => s.parameters.includes("xi_n_pa_m"))];
    await page.goto(`${service.url}/#/studies/${study.id}/live?member=${rft.id}`);
    const label = page.locator('[data-figure^="particles"] svg text', { hasText: "xi n" });
    assert.equal(await label.first().textContent(), "xi n [Pa/m]");
    assert.deepEqual(tab.faults, []);
    await shot(page, "models-live");
  } finally {
    await tab.close();
    await service.stop();
  }
});
