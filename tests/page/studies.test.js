// The buttons for a whole study begin it again from its files, archive it, take it back, delete it, or show it beside another.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { findings, open, shot, sideways } from "./browser.js";
import { Service, filesOf } from "./service.js";

const FOLDER = "tests/data/one-of-a-class";
let service, tab, page;

before(async () => {
  service = await Service.start();
  const texts = Object.fromEntries((await filesOf(FOLDER)).map(({ name, text }) => [name, text]));
  const { id } = await service.post("/v1/experiments", {
    toml: texts["experiment.toml"],
    files: { "runs.csv": texts["runs.csv"] },
  });
  for (const [name, seed] of [
    ["monday", 1],
    ["tuesday", 2],
  ]) {
    const toml = texts["job.toml"].replace(/seed = \d+/, `seed = ${seed}`);
    const { study } = await service.post("/v1/calibrations", { experiment: id, toml, files: {}, name });
    await service.finished(study);
  }
  tab = await open({ url: service.url });
  page = tab.page;
});
after(async () => {
  await tab?.close();
  await service?.stop();
});

const names = () => page.locator("a.study-name").allTextContents();

test("a study is begun again from its files", async () => {
  await page.goto(`${service.url}/#/studies/1/story`);
  await page.getByRole("link", { name: "Edit and start again" }).click();
  await page.locator(".card.file").nth(2).waitFor();
  assert.deepEqual((await page.locator(".card.file b").allTextContents()).sort(), [
    "experiment.toml",
    "job.toml",
    "runs.csv",
  ]);
  assert.equal(await page.getByLabel("Name").inputValue(), "monday");
  assert.ok(await page.getByRole("button", { name: "Start the calibration" }).isEnabled());
});

test("two studies stand beside each other", async () => {
  await page.goto(`${service.url}/#/studies/1/story`);
  const select = page.getByLabel("Beside");
  await select.focus();
  await select.locator('option[value="2"]').waitFor({ state: "attached" });
  await select.selectOption("2");
  await page.waitForURL(/#\/beside\/1\/2$/);
  await page.locator("h1", { hasText: "monday beside tuesday" }).waitFor();
  const table = page.getByRole("region", { name: "Two studies" });
  await table.locator("tr", { hasText: "friction angle" }).getByText(/ sds$/).waitFor();
  assert.match(await table.locator("tr", { hasText: "Found" }).textContent(), /slip_sinkage.*slip_sinkage/s);
  await page.locator('[data-figure*="beside"] .model path').first().waitFor({ state: "attached" });
  assert.deepEqual(await findings(page), []);
  assert.equal(await sideways(page), 0);
  await shot(page, "studies-beside");
});

test("an archived study leaves the list and comes back, and a deleted one is gone", async () => {
  await page.goto(`${service.url}/#/studies/1/story`);
  await page.getByRole("button", { name: "Archive" }).click();
  await page.getByRole("button", { name: "Take back into the list" }).waitFor();
  await page.goto(`${service.url}/#/`);
  await page.waitForFunction(() => document.querySelectorAll("a.study-name").length === 1);
  assert.deepEqual(await names(), ["tuesday"]);
  await page.getByLabel("archived studies, too").check();
  await page.getByRole("link", { name: "monday" }).click();
  await page.getByRole("button", { name: "Take back into the list" }).click();
  await page.getByRole("button", { name: "Archive" }).waitFor();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("button", { name: "Keep it" }).click();
  await page.getByRole("button", { name: "Delete", exact: true }).click();
  await page.getByRole("button", { name: "Delete it" }).click();
  await page.locator("h1", { hasText: "Studies" }).waitFor();
  await page.waitForFunction(() => document.querySelectorAll("a.study-name").length === 1);
  assert.deepEqual(await names(), ["tuesday"]);
});

test("nothing went wrong on the way", () => assert.deepEqual(tab.faults, []));
