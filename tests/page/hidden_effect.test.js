// A hidden effect, from the files to the repaired model, by clicking; the coordinator is killed on the way.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { open, shot, studyOf, view } from "./browser.js";
import { Service, filesOf } from "./service.js";
import { moveSliders } from "./sliders.js";

const FOLDER = "examples/hidden-effect";
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

// The job has so many particles that the calibration is still running when its first figure is drawn.
const ask = (job) => job.replace('apply = "auto"', 'apply = "ask"').replace("seed = 1", "seed = 1\nparticles = 4000");

test("dropped files and chosen files are the same draft", async () => {
  await page.goto(service.url);
  await page.getByRole("link", { name: "New calibration" }).first().click();
  const files = await filesOf(FOLDER, ask);
  const dropped = await page.evaluateHandle((all) => {
    const transfer = new DataTransfer();
    for (const { name, text } of all) transfer.items.add(new File([text], name));
    return transfer;
  }, files);
  await page.dispatchEvent(".drop", "drop", { dataTransfer: dropped });
  await page
    .locator(".card.file")
    .nth(files.length - 1)
    .waitFor();
  const names = await page.locator(".card.file b").allTextContents();
  for (const name of names) await page.getByRole("button", { name: `remove ${name}` }).click();
  await page
    .locator('input[type="file"]')
    .setInputFiles(files.map(({ text, ...file }) => ({ ...file, buffer: Buffer.from(text) })));
  await page
    .locator(".card.file")
    .nth(files.length - 1)
    .waitFor();
  assert.deepEqual((await page.locator(".card.file b").allTextContents()).sort(), names.sort());
  await shot(page, "hidden-new");
});

test("the page outlives its coordinator", async () => {
  await page.getByRole("button", { name: "Start the calibration" }).click();
  await page.waitForURL(/studies\/\d+\/live/);
  await page.locator('[data-figure$="ess"] svg').first().waitFor({ timeout: STUDY_MS });
  assert.equal((await service.get(`/v1/studies/${studyOf(page)}`)).state, "running");
  await service.kill();
  await page.getByText("the coordinator does not answer").first().waitFor();
  await shot(page, "hidden-live-away");
  await service.restart();
  await page.getByText("the coordinator does not answer").first().waitFor({ state: "detached" });
  await page.locator(".heading .state.finished").waitFor({ timeout: STUDY_MS });
  await page.locator('[data-figure^="particles"] svg circle').first().waitFor();
  await shot(page, "hidden-live");
});

test("a cell of the residuals lights up its run in the other pictures", async () => {
  await view(page, "Where it fails");
  const cell = page.locator('[data-figure$="residuals"] rect[data-run]').first();
  await cell.waitFor();
  const run = await cell.getAttribute("data-run");
  await cell.hover();
  const lit = page.locator(`figure:not([data-figure$="residuals"]) [data-run="${run}"].lit`);
  await lit.first().waitFor();
  await shot(page, "hidden-failures");
  await page.mouse.move(2, 2);
  assert.equal(await page.locator(".lit").count(), 0);
  await cell.click();
  const bar = page.getByRole("complementary", { name: "Chosen runs" });
  await bar.waitFor();
  const here = page.url();
  // Another study has other runs.
  await page.getByRole("link", { name: "Studies", exact: true }).click();
  await page.locator("h1", { hasText: "Studies" }).waitFor();
  await page.goto(here.replace(/[?&]runs=[^&]*/, ""));
  await cell.waitFor();
  assert.equal(await bar.count(), 0);
});

test("an explanation shows what it predicts before it is computed, and a click adds it", async () => {
  await view(page, "Missing effect");
  const button = page.getByRole("button", { name: "show what janosi_hanamoto would change" });
  await button.hover();
  await page.locator(".ghosts .ghost").first().waitFor({ state: "attached" });
  assert.match(
    await page.locator(".ghosts .note").first().textContent(),
    /Shear stress needs displacement along the rim to build up: the dashed curves are what it would predict/,
  );
  await shot(page, "hidden-effects");
  // Every picture is seen beside the list, and no words run into each other on a narrow screen.
  assert.equal(await page.locator(".ghosts figure").count(), 3);
  const hidden = await page.locator(".ghosts").evaluate((ghosts) => ghosts.scrollHeight - ghosts.clientHeight);
  assert.ok(hidden <= 0, `${hidden} px of the pictures are hidden`);
  await page.setViewportSize({ width: 400, height: 800 });
  const apart = await page.locator(".explanations tbody tr").evaluateAll((rows) =>
    rows.map((row) => {
      const [probability, strength] = [".number", "td:nth-child(4)"].map((part) =>
        row.querySelector(part)?.getBoundingClientRect(),
      );
      return strength ? strength.left - probability.right : 1;
    }),
  );
  assert.ok(
    apart.every((gap) => gap > 0),
    JSON.stringify(apart),
  );
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.getByRole("button", { name: "add janosi_hanamoto" }).click();
  await page.getByRole("button", { name: "Not now" }).click();
  await page.getByRole("button", { name: "add janosi_hanamoto" }).click();
  await page.getByRole("button", { name: "Add it" }).click();
  await page.waitForURL(/live/);
  const study = await service.finished(studyOf(page), STUDY_MS);
  assert.deepEqual(study.members.find((m) => m.id === study.current).effects, ["janosi_hanamoto"]);
});

test("the story begins with the error before and after, and the picture of both models", async () => {
  const id = studyOf(page);
  await page.locator(".heading .state.finished").waitFor({ timeout: STUDY_MS });
  await view(page, "Story");
  const found = page.getByRole("region", { name: "What was found" });
  const { ledger } = await service.get(`/v1/studies/${id}`);
  const [before, now] = ledger.map((line) => line.error.holdout.drawbar_pull.rmse);
  const words = (value) => value.toPrecision(value < 1 ? 2 : 3);
  const row = await found.locator("tr", { hasText: "Drawbar pull" }).textContent();
  assert.ok(row.includes(`${words(before)}\u00a0→\u00a0${words(now)}\u00a0N`), row);
  assert.match(
    await found.locator("h2").textContent(),
    / of held-out runs: error [\d.]+\u00a0→\u00a0[\d.]+\u00a0N.* with one more effect\.$/,
  );
  assert.match(
    await found.textContent(),
    /shear stress needs displacement along the rim to build up, shear modulus 9\.\d+ ± 0\.\d+ mm/,
  );
  await found.locator(".model path").first().waitFor({ state: "attached" });
  // A screen of 800 lines shows what was wrong, what was missing, how sure that is and what it bought, with the picture.
  for (const part of ["h2", "b", ".errors", ".bars", ".plot svg"]) {
    const { y, height } = await found.locator(part).first().boundingBox();
    assert.ok(y + height <= 800, `${part} ends at ${y + height} px`);
  }
  assert.equal(
    await found
      .locator(".legend")
      .getByText(/^(base|with janosi_hanamoto)$/)
      .count(),
    2,
  );
  assert.ok((await page.locator(".three > .card").last().locator("> ol > li").count()) <= 3);
  await shot(page, "hidden-story");
});

test("the error falls, and the models are layers", async () => {
  const id = studyOf(page);
  await page.locator(".heading .state.finished").waitFor({ timeout: STUDY_MS });
  await view(page, "Error falls");
  const { ledger } = await service.get(`/v1/studies/${id}`);
  const [base, extended] = ledger.map((line) => line.error.holdout.all.rmse_fixed_sigma);
  const pull = ledger.at(-1).error.holdout.drawbar_pull.rmse;
  assert.match(
    await page.locator("table", { hasText: "with janosi_hanamoto" }).first().textContent(),
    new RegExp(pull.toPrecision(3).replace(".", "\\.")),
  );
  assert.ok(extended < base, `held out, the extension errs by ${extended} noise sds, the base by ${base}`);
  const layers = page.getByRole("group", { name: "Models that are shown" }).getByRole("button");
  assert.equal(await layers.count(), 2);
  const curves = page.locator('[data-figure*="layers-drawbar"] .model path');
  await curves.first().waitFor({ state: "attached" });
  await page.waitForTimeout(300);
  const both = await curves.count();
  await layers.first().click();
  await page.waitForTimeout(300);
  assert.ok((await curves.count()) < both, "a layer that is switched off is still drawn");
  await shot(page, "hidden-errors");
});

test("sliders of the parameters move the curves of the model", async () => {
  await view(page, "Compare");
  const { parameters } = await service
    .get(`/v1/studies/${studyOf(page)}`)
    .then(({ current }) => service.get(`/v1/calibrations/${current}/response-surface`));
  assert.ok(
    parameters.some(({ name }) => name.startsWith("janosi_hanamoto.")),
    "no slider for the strength of the effect",
  );
  await moveSliders(page, parameters.length);
  await shot(page, "hidden-sliders");
});

test("sliders predict what nobody measured, and say where the fitted runs end", async () => {
  await view(page, "Predict");
  const { current } = await service.get(`/v1/studies/${studyOf(page)}`);
  const values = page.getByRole("region", { name: "Predictions at the chosen condition" });
  const computed = page.getByText(/Computed at this condition with \d+ draws/);
  await computed.waitFor();
  await page.getByText("Within the fitted range.").waitFor();
  const rows = (await service.get(`/v1/calibrations/${current}/comparison`)).rows;
  // The numbers are those of the service.
  const number = async (label) => Number(await page.getByLabel(label, { exact: true }).inputValue());
  const [slip, load, rim] = [await number("slip"), await number("wheel load"), await number("speed of the rim")];
  const plan = `slip,wheel_load_n,sled_speed_m_s\n${slip},${load},${rim * (1 - slip)}\n`;
  const answer = await service.post(`/v1/calibrations/${current}/predict`, {
    plan,
    statements: ["drawbar_pull_n > 10"],
  });
  const pull = answer.runs[0].quantities.find((q) => q.name === "drawbar_pull_n").models_mean;
  const shown = async () =>
    Number(
      (await values.locator("tr", { hasText: "Drawbar pull" }).locator("td").first().textContent()).replace("−", "-"),
    );
  assert.ok(Math.abs((await shown()) / pull - 1) < 0.01, `${await shown()} is not ${pull}`);
  assert.ok(
    rows.some((row) => row.wheel_load_n === load),
    "the sliders begin at a load that was run",
  );
  await page.getByLabel("limit [N]").fill("10");
  await page.getByText(/^P [\d<>. ]+$/).waitFor();
  const p = answer.runs[0].statements[0].measurement;
  const said = Number((await page.locator("p.answer b").textContent()).replace(/[^\d.]/g, ""));
  assert.ok(Math.abs(said - p) < 0.02, `${said} is not ${p}`);
  await shot(page, "hidden-predict");
  // A key moves a slider; the curve follows before anything is computed.
  const before = await shown();
  await page.getByLabel("wheel load", { exact: true }).press("End");
  await page.getByText("Beyond the fitted range in wheel load").waitFor();
  assert.ok((await shown()) > before + 1, "the pull does not follow the load");
  await page.getByText("Interpolated between computed conditions").waitFor();
  const moved = await shown();
  await computed.waitFor();
  assert.ok(Math.abs((await shown()) - moved) < 1, `${moved} was interpolated, ${await shown()} is computed`);
});

test("a condition that the model refuses at every slip is said with its reason in the place of the curve", async () => {
  const reason = "no_support: condition 3: the soil carries at most 80 N of the 140 N wheel load";
  const refused = (/** @type {any} */ run) => ({
    ...run,
    quantities: [],
    statements: [],
    refused: { draws: 40, of: 40, reason },
  });
  await page.route("**/predict", async (route) => {
    const answer = await (await route.fetch()).json();
    await route.fulfill({ json: { ...answer, runs: answer.runs.map(refused) } });
  });
  await view(page, "Story");
  await view(page, "Predict");
  await page
    .getByText(
      /The model refuses every slip from 0 to 0\.\d+ at \S+ N, .*: the soil carries at most 80 N of the 140 N wheel load \(at 40 of 40 draws\)/,
    )
    .waitFor();
  assert.equal(await page.locator(".view.predict [aria-busy]").count(), 0);
  await page.unroute("**/predict");
});

test("runs of a region can be left out, as a study of its own", async () => {
  const id = studyOf(page);
  await view(page, "Compare");
  const picture = page.locator('[data-figure*="drawbar"] .plot > svg').first();
  await picture.waitFor();
  await shot(page, "hidden-compare");
  await picture.scrollIntoViewIfNeeded();
  const box = await picture.boundingBox();
  await page.mouse.move(box.x + 0.7 * box.width, box.y + 0.25 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.85 * box.width, box.y + 0.4 * box.height, { steps: 4 });
  await page.mouse.move(box.x + 0.99 * box.width, box.y + 0.4 * box.height, { steps: 4 });
  await page.mouse.up();
  await page.getByRole("complementary", { name: "Chosen runs" }).waitFor();
  await page.getByRole("button", { name: "What if these runs were left out?" }).click();
  // What changed without them stands beside what was.
  await page.waitForURL((url) => url.hash.startsWith(`#/beside/${id}/`));
  const study = await service.finished(Number(page.url().split("/").at(-1)), STUDY_MS);
  assert.equal(study.state, "finished");
  assert.notEqual(study.id, id);
  const radius = page.getByRole("region", { name: "Two studies" }).locator("tr", { hasText: "wheel radius" });
  await radius.getByText(/^−?\d.* sds$/).waitFor();
  assert.equal((await radius.textContent()).match(/ ± .* mm/g)?.length, 1);
  await page.locator('[data-figure*="beside"] .model path').first().waitFor({ state: "attached" });
  await shot(page, "hidden-beside");
});

test("nothing went wrong on the way", () => assert.deepEqual(tab.faults, []));
