// A thousand runs: no view has more than 3,000 elements, and a run is still pointed at and chosen.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { open, shot, view } from "./browser.js";
import { Service, filesOf } from "./service.js";

const RUNS = 1000;
const MOST_ELEMENTS = 3000;
/** Every view, with what it has once it is drawn. */
const VIEWS = {
  Story: ".plot svg",
  "Where it fails": ".plot svg",
  "Missing effect": ".plot svg",
  Posterior: ".plot svg",
  Predict: ".plot svg",
  "Error falls": ".plot svg",
  "How far to trust it": "table",
  Decide: ".empty",
  Live: "table",
  Compare: ".plot svg",
};
let service, tab, page, study;

/** The runs of the example again and again, each a little off; the same in every run of the test. */
function manyRuns(text) {
  const [head, ...runs] = text
    .trim()
    .split("\n")
    .filter((line) => !line.startsWith("#"));
  const [name, slip, pull] = ["run", "slip", "drawbar_pull_n"].map((column) => head.split(",").indexOf(column));
  const rows = Array.from({ length: RUNS }, (_, k) => {
    const cells = runs[k % runs.length].split(",");
    const off = Math.sin(k);
    cells[name] = `m${String(k).padStart(4, "0")}`;
    cells[slip] = String(Number(cells[slip]) + 0.004 * off);
    cells[pull] = String(Number(cells[pull]) + off);
    return cells.join(",");
  });
  return `${[head, ...rows].join("\n")}\n`;
}

before(async () => {
  service = await Service.start();
  const texts = Object.fromEntries((await filesOf("examples/hidden-effect")).map(({ name, text }) => [name, text]));
  const { id } = await service.post("/v1/experiments", {
    toml: texts["experiment.toml"],
    files: { "runs.csv": manyRuns(texts["runs.csv"]) },
  });
  const toml = texts["job.toml"]
    .replace("[sampler]", '[sampler]\nalgorithm = "lm"')
    .replace(/\[discovery\][\s\S]*/, "");
  const created = await service.post("/v1/calibrations", { experiment: id, toml, files: {}, name: "many" });
  study = created.study;
  assert.equal((await service.finished(study)).state, "finished");
  await service.post(`/v1/calibrations/${created.id}/discovery`, {});
  assert.equal((await service.finished(study)).state, "finished");
  tab = await open({ url: service.url });
  page = tab.page;
});
after(async () => {
  await tab?.close();
  await service?.stop();
});

const elements = () => page.evaluate(() => document.querySelectorAll("*").length);

test("no view of a thousand runs has more than 3,000 elements", async () => {
  await page.goto(`${service.url}/#/studies/${study}/story`);
  for (const [title, part] of Object.entries(VIEWS)) {
    await view(page, title);
    await page.locator(`section.view :is(${part})`).first().waitFor();
    await page.locator('[aria-busy="true"]').first().waitFor({ state: "detached" });
    assert.ok((await elements()) <= MOST_ELEMENTS, `${title}: ${await elements()} elements`);
  }
  await page.getByRole("button", { name: "wheel load" }).click();
  await page.locator('[data-figure*="drawbar"] .plot svg').first().waitFor();
  await page.getByText("Table of all runs").click();
  await page.getByText("rows 1 to 120 of 3000").waitFor();
  await page.getByRole("button", { name: "Rows after" }).click();
  await page.getByText("rows 121 to 240 of 3000").waitFor();
  assert.ok((await elements()) <= MOST_ELEMENTS, `against the load, with the table: ${await elements()} elements`);
  await shot(page, "many-compare");
});

test("a run among a thousand lights up where it is pointed at, and a click chooses it", async () => {
  await view(page, "Where it fails");
  const map = page.locator('[data-figure$="residuals"] .plot > svg');
  await map.waitFor();
  const box = await map.boundingBox();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 40);
  await page.locator('figure:not([data-figure$="residuals"]) .merged .lit').first().waitFor({ state: "attached" });
  await page.mouse.click(box.x + 0.6 * box.width, box.y + 40);
  await page
    .getByRole("complementary", { name: "Chosen runs" })
    .getByText(/^run m\d{4}$/)
    .waitFor();
  await page.getByRole("button", { name: "Let them go" }).click();
  await page.mouse.move(2, 2);
  await page.locator(".lit").first().waitFor({ state: "detached" });
  await shot(page, "many-failures");
});

test("nothing went wrong on the way", () => assert.deepEqual(tab.faults, []));
