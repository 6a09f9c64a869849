// A German spreadsheet, from the drop to a calibration, by clicking.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";

import { findings, open, shot, sideways, studyOf } from "./browser.js";
import { Service } from "./service.js";

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

const choose = (label, value) => page.getByLabel(label, { exact: true }).selectOption(value);
const files = async (...given) => page.locator('input[type="file"]').setInputFiles(given);
const buffer = (name, text) => ({ name, mimeType: "text/csv", buffer: Buffer.from(text, "latin1") });

test("what the file does not state is marked at its field", async () => {
  await page.goto(`${service.url}/#/new`);
  await page.getByRole("link", { name: "New calibration" }).first().click();
  // It stands among the examples.
  await page.getByRole("button", { name: "Messung_Sand.xlsx" }).click();
  const card = page.locator(".card.mapping");
  await card.getByText("The columns of Messung_Sand.xlsx").waitFor();
  assert.equal(await page.getByLabel("unit of wheel load", { exact: true }).inputValue(), "kN");
  assert.equal(await page.getByLabel("unit of torque", { exact: true }).inputValue(), "N cm");
  assert.equal(await page.getByLabel("column of slip", { exact: true }).inputValue(), "Schlupf [%]");
  await card.locator('[data-field="wheel"]').waitFor();
  await card.locator('[data-field="r"]').first().waitFor();
  assert.ok(await page.getByRole("button", { name: /Use these columns/ }).isDisabled());
  assert.deepEqual(await findings(page), []);
  assert.equal(await sideways(page), 0);
  await shot(page, "import-questions");
});

test("a wrong unit is complained about at its field, with the cell", async () => {
  await page.getByLabel("wheel of all rows", { exact: true }).fill("w");
  await page.getByLabel("soil of all rows", { exact: true }).fill("s");
  await page
    .getByLabel("radius with which the rig converts slip to rim speed of all rows", { exact: true })
    .fill("125");
  await choose("unit of radius with which the rig converts slip to rim speed", "mm");
  await page.getByRole("button", { name: "Use these 40 runs" }).waitFor();
  await choose("unit of slip", "1");
  const said = page.locator('[data-field="slip"]').first();
  await said.waitFor();
  assert.match(await said.textContent(), /cell C5: slip 5 must lie in \[-1, 1\)/);
  await choose("unit of slip", "%");
  await page.getByRole("button", { name: "Use these 40 runs" }).waitFor();
  assert.equal(await page.locator('[data-field="slip"]').count(), 0);
  await page.getByText("kept as notes, no columns of runs.csv: Drehzahl [U/min], Bemerkung").waitFor();
  await shot(page, "import-answered");
});

test("the runs are those of the command, and become a calibration", async () => {
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save runs.csv" }).click();
  const expected = await readFile("examples/import-german/runs.csv", "utf8");
  assert.equal(await readFile(await (await saved).path(), "utf8"), expected);
  await page.getByRole("button", { name: "Use these 40 runs" }).click();
  await page.getByText("Wheel and noise").waitFor();
  await page.getByLabel("radius of wheel w [mm]").fill("125");
  await page.getByLabel("width of wheel w [mm]").fill("112");
  await page.getByText("Priors: those of dry sands").click();
  await page.getByLabel("form of the prior of n").selectOption("uniform");
  await page.getByLabel("number 1 of the prior of n").fill("1.2");
  await page.getByLabel("number 2 of the prior of n").fill("0.9");
  await page.getByRole("button", { name: "Write experiment.toml and job.toml" }).click();
  await page.getByText("prior of n: two numbers, the smaller first").waitFor();
  await page.getByLabel("number 2 of the prior of n").fill("1,4");
  await page.getByText("Effects from the start: none").click();
  await page.getByRole("checkbox", { name: /^janosi hanamoto/ }).check();
  assert.deepEqual(await findings(page), []);
  await shot(page, "import-choices");
  await page.getByRole("button", { name: "Write experiment.toml and job.toml" }).click();
  const job = page.getByLabel("text of job.toml");
  assert.match(await job.inputValue(), /kind = "quasi_static"\neffects = \["janosi_hanamoto"\]/);
  assert.match(await job.inputValue(), /^n = \{ uniform = \[1\.2, 1\.4\] \}/m);
  await page.getByRole("button", { name: "Check, with its cost" }).click();
  const check = page.getByRole("region", { name: "What the job will do" });
  await check.getByText("quasi_static with janosi_hanamoto").waitFor();
  await shot(page, "import-check");
  // What was checked is what stands there.
  await page.getByText("Text of job.toml").click();
  await job.fill(`${await job.inputValue()}# changed\n`);
  assert.equal(await check.count(), 0);
  await page.getByRole("button", { name: "Start the calibration" }).click();
  await page.waitForURL(/studies\/\d+\/live/);
  const [experiment] = await service.get("/v1/experiments");
  assert.equal((await service.get(`/v1/experiments/${experiment.id}`)).files["runs.csv"], expected);
});

test("a text in another encoding keeps its letters, and a file that is no table says so", async () => {
  await page.getByRole("link", { name: "New calibration" }).first().click();
  await files(
    buffer(
      "Sand.csv",
      "Versuch;Schlupf [%];Last [N];Geschwindigkeit [mm/s];Einsinkung [mm];Prüfstand\nA;20;100;8;5,5;Jürgen\nB;30;100;8;6,5;Zoë\n",
    ),
  );
  await page.getByLabel("wheel of all rows", { exact: true }).fill("w");
  await page.getByLabel("soil of all rows", { exact: true }).fill("s");
  await page.getByText("kept as notes, no columns of runs.csv: Prüfstand").waitFor();
  await page.getByRole("button", { name: "remove Sand.csv" }).click();
  await files({ name: "broken.xlsx", mimeType: "application/octet-stream", buffer: Buffer.from("PK\x03\x04rubbish") });
  await page.locator(".card.mapping .error").first().waitFor();
  assert.match(await page.locator(".card.mapping .error").first().textContent(), /broken\.xlsx: the file is damaged/);
});

test("a row of means is left out by a click, and words hold runs out", async () => {
  await page.goto(`${service.url}/#/`);
  await page.getByRole("link", { name: "New calibration" }).first().click();
  await files({
    name: "Messung.csv",
    mimeType: "text/csv",
    buffer: await readFile("tests/data/german-table/Messung.csv"),
  });
  const wheel = page.locator('[data-field="wheel"]');
  await wheel.waitFor();
  assert.equal(await wheel.textContent(), "Which wheel? Choose its column, or give one name for all rows.");
  await page.getByLabel("wheel of all rows", { exact: true }).fill("w");
  await page.getByLabel("soil of all rows", { exact: true }).fill("s");
  const means = page.locator(".card.mapping .error", { hasText: "Mittelwert" });
  await means.waitFor();
  assert.match(await means.textContent(), /line 44: the row "Mittelwert" is no run\s*Mittelwert · – · – · – · /);
  assert.deepEqual(await findings(page), []);
  await shot(page, "import-means");
  await page.getByRole("button", { name: "Leave out line 44" }).click();
  await page.getByRole("button", { name: "Use these 40 runs" }).waitFor();
  await page.getByRole("button", { name: "Undo: take in line 44 again" }).click();
  await page.getByRole("button", { name: "Leave out line 44" }).click();
  assert.equal(await page.getByLabel("meaning of Kontrolle", { exact: true }).inputValue(), "holdout");
  assert.equal(await page.getByLabel("meaning of neu geharkt", { exact: true }).inputValue(), "fit");
  await page.getByRole("button", { name: "Use these 40 runs" }).waitFor();
  assert.deepEqual(await findings(page), []);
  assert.equal(await sideways(page), 0);
  await shot(page, "import-held-out");
});

test("the runs that the words hold out judge the calibration", async () => {
  await page.getByRole("button", { name: "Use these 40 runs" }).click();
  await page.getByText("Wheel and noise").waitFor();
  const experiment = await readFile("tests/data/nothing-hidden/experiment.toml", "utf8");
  const job = (await readFile("examples/import-german/job.toml", "utf8"))
    .replace("[sampler]", '[sampler]\nalgorithm = "lm"')
    .replace(/\[discovery\][^[]*/, "");
  await files(buffer("experiment.toml", experiment), buffer("job.toml", job));
  await page.getByLabel("Tags").fill("dry");
  // A description that is not kept is no failed submission: a second click would begin a second study.
  await page.route("**/details", (route) => route.abort());
  const start = page.getByRole("button", { name: "Start the calibration" });
  await start.click();
  await page.getByText("The calibration runs, but its author and tags were not kept").waitFor();
  assert.ok(await start.isDisabled());
  await page.unroute("**/details");
  await page.getByRole("link", { name: "See it run" }).click();
  await page.waitForURL(/studies\/\d+\/live/);
  const study = await service.finished(studyOf(page));
  assert.equal(study.state, "finished");
  const { rows } = await service.get(
    `/v1/calibrations/${study.calibrations[0].id ?? study.calibrations[0]}/comparison`,
  );
  assert.equal(new Set(rows.filter((row) => row.use === "holdout").map((row) => row.run)).size, 16);
});

test("blank cells of a block take the value above by a click, and keep none by another", async () => {
  await page.getByRole("link", { name: "New calibration" }).first().click();
  await files(
    buffer(
      "Block.csv",
      "Versuch;Rad;Boden;Schlupf [%];Last [N];Geschwindigkeit [mm/s];Einsinkung [mm]\nA;w;s;20;100;8;5,5\nB;w;s;30;;8;6,5\nC;w;s;40;;8;7,5\n",
    ),
  );
  const fill = page.getByRole("button", { name: "Blank cells have the value above" });
  await fill.click();
  await page.getByRole("button", { name: "Use these 3 runs" }).waitFor();
  await shot(page, "import-filled");
  await page.getByRole("button", { name: "Undo: blank cells of wheel load stay blank" }).click();
  await fill.waitFor();
  await page.getByRole("button", { name: "remove Block.csv" }).click();
});

test("nothing went wrong on the way", () => assert.deepEqual(tab.faults, []));
