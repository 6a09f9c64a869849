import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { fits, launch, open, picture, stumbles } from "./browser.js";
import { command } from "./service.js";

let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "report-"));
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

for (const example of ["hidden-effect", "cmu-sand"]) {
  test(`the report of ${example} opens offline and begins with the story`, async () => {
    const out = join(folder, example);
    command(["run", `examples/${example}/job.toml`, "--out", out]);
    const { page, complaints } = await open(browser, pathToFileURL(join(out, "report.html")).href);
    await page.locator("#compare svg").first().waitFor();
    await page.waitForTimeout(500);
    const first = await page.locator("section").first().textContent();
    assert.match(first, /What the model gets wrong.*What is missing.*What to do next/s);
    for (const section of ["story", "live", "compare", "failures", "posterior", "errors"]) {
      assert.ok((await page.locator(`#${section} figure svg`).count()) > 0, section);
    }
    assert.equal(await page.locator(".error").count(), 0);
    await picture(page, `report-${example}`);
    assert.deepEqual(await stumbles(page), []);
    await fits(page, "the report");
    assert.deepEqual(complaints, []);
  });
}

test("the report of a calibration shows its own model", async () => {
  const file = join(folder, "base.html");
  command(["report", "1", "--out", join(folder, "hidden-effect"), "--output", file]);
  const { page } = await open(browser, pathToFileURL(file).href);
  await page.getByText(/quasi_static, base/).waitFor();
  await page.locator("#story").getByText(/held-out/).first().waitFor();
});
