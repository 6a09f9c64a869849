// Measured sand: from the example to the explanations, then runs that were made are typed in and the study is calibrated with all.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { open, shot, studyOf, view } from "./browser.js";
import { Service } from "./service.js";

const STUDY_MS = 600_000;
let service, tab, page;

before(async () => {
  service = await Service.start();
  tab = await open({ url: service.url });
  page = tab.page;
});
after(async () => {
  await tab?.close();
  await service?.stop();
});

test("an example is edited in the form and calibrated", async () => {
  await page.goto(`${service.url}/#/new`);
  await page.getByRole("button", { name: "cmu-sand-discover", exact: true }).click();
  const card = page.locator('[data-file="discover.toml"]');
  await card.locator("summary").click();
  const text = page.getByLabel("text of discover.toml");
  // Fewer particles keep the test short; the search waits for a click.
  const job = (await text.inputValue())
    .replace(/particles = \d+/, "particles = 200")
    .replace(/moves = .*/, "")
    .replace('apply = "auto"', 'apply = "ask"');
  await text.fill(job);
  await page.getByRole("button", { name: "Start the calibration" }).click();
  await page.waitForURL(/live/);
  await page.locator(".heading .state.finished").waitFor({ timeout: STUDY_MS });
  for (const title of ["Compare", "Where it fails", "Posterior", "Error falls"]) {
    await view(page, title);
    await page.locator(`section[aria-label="${title}"] figure .plot > svg`).first().waitFor();
    await shot(page, `cmu-${title.toLowerCase().replaceAll(" ", "-")}`);
  }
});

test("regions of the corner plot end at their cells", async () => {
  await view(page, "Posterior");
  const inside = page.locator('[data-figure^="pairs"] .plot > svg svg');
  await inside.first().waitFor();
  assert.deepEqual(
    [...new Set(await inside.evaluateAll((all) => all.map((svg) => getComputedStyle(svg).overflow)))],
    ["hidden"],
  );
});

test("the explanations come with a map of the runs that would tell", async () => {
  await view(page, "Missing effect");
  await page.locator("table.explanations tbody tr").first().waitFor();
  await page.locator('section[aria-label="Missing effect"] figure .plot > svg').last().waitFor();
  const cells = page.locator('[data-figure*="next-runs"] g[fill] rect, [data-figure*="next-runs"] rect[fill]');
  const fills = await cells.evaluateAll((all) =>
    all.map((cell) => cell.getAttribute("fill")).filter((fill) => fill?.startsWith("color-mix")),
  );
  assert.ok(fills.length > 20, `${fills.length} cells`);
  assert.deepEqual(
    fills.filter((fill) => fill.includes(" -")),
    [],
  );
  assert.deepEqual(await page.evaluate((all) => all.filter((fill) => !CSS.supports("fill", fill)), fills), []);
  await page.locator(".ramp").waitFor();
  await page.locator("table.explanations button.plain").first().focus();
  await page.locator(".ghosts .note b").first().waitFor();
  await shot(page, "cmu-effects");
});

test("measured values of the proposed runs start a calibration of all", async () => {
  const id = studyOf(page);
  const before = await service.get(`/v1/studies/${id}`);
  // What the model predicts nearby will do for a measurement.
  await page.getByLabel("pull of run 1 in N").fill("3.5");
  await page.getByLabel("sinkage of run 1 in mm").fill("14,5");
  await page.getByLabel("wheel of run 1").selectOption("grousered");
  await page.getByRole("button", { name: "Add 1 run and calibrate again" }).click();
  await page.waitForURL((url) => /live/.test(url.hash));
  const added = studyOf(page);
  const study = await service.finished(added, STUDY_MS);
  assert.equal(study.state, "finished");
  assert.ok(added !== id || study.members.length > before.members.length, "there is no calibration with the new run");
  const { rows } = await service.get(`/v1/calibrations/${study.current}/comparison`);
  const own = rows.filter((row) => row.run.startsWith("next-"));
  assert.deepEqual(own.map((row) => [row.wheel, row.channel, row.measured]).sort(), [
    ["grousered", "drawbar_pull", 3.5],
    ["grousered", "sinkage", 0.0145],
  ]);
  await page.goto(`${service.url}/#/studies/${study.id}/errors`);
  const names = await page.getByRole("group", { name: "Models that are shown" }).getByRole("button").allTextContents();
  assert.equal(new Set(names).size, names.length, `models share a name: ${names}`);
  await page.locator('[data-figure*="layers"] [data-run^="next-"]').first().waitFor({ state: "attached" });
  // Errors and evidence over different runs stand apart.
  const picture = page.locator('[data-figure*="error-drawbar"] .plot > svg');
  assert.match(
    await picture
      .locator("text")
      .allTextContents()
      .then((all) => all.join(" ")),
    /\+ 1 run/,
  );
  const ends = study.ledger.map((line) => line.data_set).filter((set, k, all) => k === 0 || set !== all[k - 1]).length;
  assert.ok(ends > 1);
  assert.equal(await picture.locator(".errors path").count(), 2 * ends);
  const outside = await page.evaluate(
    () =>
      [...document.querySelectorAll('[data-figure*="error-"] .plot > svg')].flatMap((svg) => {
        const frame = svg.getBoundingClientRect();
        const boxes = [...svg.querySelectorAll("line, path")].map((line) => line.getBoundingClientRect());
        return boxes.filter((box) => box.left < frame.left - 1 || box.right > frame.right + 1);
      }).length,
  );
  assert.equal(outside, 0, "lines leave their picture");
  assert.equal(
    await page.getByRole("region", { name: /^Error ledger, / }).count(),
    new Set(study.ledger.map((line) => line.data_set)).size,
  );
  await shot(page, "cmu-errors-more-runs");
});

test("nothing went wrong on the way", () => assert.deepEqual(tab.faults, []));
