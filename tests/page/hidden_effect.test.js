import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";

import { finished, launch, open, picture, view } from "./browser.js";
import { Service } from "./service.js";

const EXAMPLE = new URL("../../examples/hidden-effect/", import.meta.url);
const text = (name) => readFileSync(new URL(name, EXAMPLE), "utf8");
// A person adds the effect here, not the study itself.
const job = text("job.toml").replace('"auto"', '"ask"');
const files = [["job.toml", job], ["experiment.toml", text("experiment.toml")], ["runs.csv", text("runs.csv")]];

let service;
let browser;
before(async () => {
  service = await Service.start();
  browser = await launch();
});
after(async () => {
  await browser.close();
  await service.stop();
});

test("from dropped files to a repaired model by clicking, though the coordinator is killed in the middle", async () => {
  assert.ok(job.includes('"ask"'));
  const { page, complaints } = await open(browser, service.url);
  await page.getByRole("link", { name: "New calibration" }).first().click();
  await page.locator("input[type=file]").setInputFiles(files.map(([name, body]) => ({ name, mimeType: "text/plain", buffer: Buffer.from(body) })));
  await page.getByRole("button", { name: /^Start/ }).click();
  await page.waitForURL(/#\/studies\/1\/live/);
  await page.locator(".state.running").first().waitFor();
  await service.kill();
  await page.getByText("the coordinator does not answer").first().waitFor();
  await service.spawn();
  await finished(page);
  await picture(page, "hidden-live");

  await view(page, "Compare");
  await page.locator('[data-figure*="drawbar-pull"] .plot svg').first().waitFor();
  await picture(page, "hidden-compare");
  await view(page, "Where it fails");
  const cell = page.locator('[data-figure$="residuals"] rect[data-run="r05"]').first();
  await cell.hover();
  const others = page.locator('[data-figure*="residuals-drawbar-pull"] [data-run="r05"].lit');
  await others.first().waitFor();
  assert.equal(await page.locator('[data-run="r06"].lit').count(), 0);
  await picture(page, "hidden-failures");

  await view(page, "Missing effect");
  const row = page.getByRole("row", { name: /janosi_hanamoto/ });
  assert.equal(await page.locator(".ghost").count(), 0);
  await row.hover();
  await page.locator(".ghosts .ghost").first().waitFor({ state: "attached" });
  await page.getByText("Nothing has been computed anew").waitFor();
  await picture(page, "hidden-ghost");
  await page.getByRole("button", { name: "add janosi_hanamoto" }).click();
  await page.waitForURL(/live/);
  await page.getByRole("cell", { name: /janosi_hanamoto/ }).or(page.getByRole("rowheader", { name: /janosi_hanamoto/ })).first().waitFor();
  await finished(page);

  await view(page, "Error falls");
  await page.locator('[data-figure*="error-drawbar-pull"] .plot svg').first().waitFor();
  await picture(page, "hidden-errors");
  const { ledger } = await service.json("/v1/studies/1");
  const [base, repaired] = ledger.map((line) => line.error.holdout.drawbar_pull.rmse);
  assert.ok(repaired < base / 5, `held out ${base} N, then ${repaired} N`);
  const layer = page.getByRole("button", { name: "base", exact: true });
  assert.equal(await layer.getAttribute("aria-pressed"), "true");
  await layer.click();
  assert.equal(await layer.getAttribute("aria-pressed"), "false");
  await view(page, "Story");
  await page.getByText(/janosi_hanamoto was missing/).waitFor();
  await picture(page, "hidden-story");
  assert.deepEqual(complaints, []);
});

test("runs that are brushed out become a study without them", async () => {
  const { page, complaints } = await open(browser, `${service.url}#/studies/1/compare`);
  const plot = page.locator('[data-figure*="drawbar-pull"] .plot svg').first();
  await plot.waitFor();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + 60, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 60, { steps: 5 });
  await page.mouse.up();
  const bar = page.getByRole("complementary", { name: "Chosen runs" });
  await bar.getByText(/slip .* to/).waitFor();
  assert.ok((await page.locator("[data-run].chosen").count()) > 0);
  await picture(page, "hidden-brushed");
  await bar.getByRole("button", { name: "What if these runs were left out?" }).click();
  await page.waitForURL(/#\/studies\/2\/live/);
  await finished(page);
  const { rows } = await service.json("/v1/calibrations/" + (await service.json("/v1/studies/2")).current + "/comparison");
  const fitted = rows.filter((row) => row.use === "fit");
  assert.ok(fitted.length > 0 && fitted.every((row) => row.slip > 0.05), "the runs of least slip are held out");
  assert.deepEqual(complaints, []);
});
