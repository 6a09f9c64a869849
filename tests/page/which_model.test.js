// Several models compared: the report says which one it is, and shows the table.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { findings, open, shot, sideways } from "./browser.js";
import { coordinator } from "./service.js";

let folder;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "models-"));
  await coordinator("run", "examples/which-model/job.toml", "--out", join(folder, "out"));
});
after(() => rm(folder, { recursive: true, force: true }));

for (const [theme, width] of [["light", 1280], ["dark", 400]]) {
  test(`the chosen model stands first, with what speaks for it, ${theme}, ${width} px`, async () => {
    const url = pathToFileURL(join(folder, "out", "report.html")).href;
    const tab = await open({ url, theme, width });
    const { page } = tab;
    try {
      await page.goto(url);
      await page.locator("section#trust").waitFor();
      assert.match(await page.locator(".verdict").first().textContent(), /wong_reece is the most probable of 3 models/);
      const rows = page.getByRole("region", { name: "Which model" }).locator("tbody tr");
      assert.deepEqual(await rows.locator("th").allTextContents(), ["wong_reece", "quasi_static", "rft"]);
      assert.match(await rows.first().textContent(), /47\.\d+ ± 0\.\d+> 0\.999.*chosen; predicts best/);
      assert.match(await page.locator("header .note").first().textContent(), /^wong_reece; compared: quasi_static, wong_reece, rft$/);
      assert.deepEqual(await findings(page), []);
      assert.equal(await sideways(page), 0);
      assert.deepEqual(tab.faults, []);
      await shot(page, `models-${theme}-${width}`);
    } finally {
      await tab.close();
    }
  });
}
