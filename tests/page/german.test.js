// A German engineer, from the spreadsheet to the summary on paper, by clicking: in German, with decimal commas, without a terminal.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { GERMAN } from "../../coordinator/page/modules/language/german.js";
import { findings, open, shot, sideways, studyOf } from "./browser.js";
import { Service } from "./service.js";

const FILE = "examples/import-german/Messung_Sand.xlsx";
const RADIUS = "Radius, mit dem der Prüfstand Schlupf in Umfangsgeschwindigkeit umrechnet";
const STUDY_MS = 600_000;
let service, tab, page;

before(async () => {
  service = await Service.start();
  tab = await open({ url: service.url, locale: "de-DE" });
  page = tab.page;
});
after(async () => {
  await tab?.close();
  await service?.stop();
});

/** Number of lines of the text of an element. */
const linesOf = (element) => {
  const range = document.createRange();
  range.selectNodeContents(element);
  return new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size;
};

const fill = (label, value) => page.getByLabel(label, { exact: true }).fill(value);

test("the page speaks the language of the browser", async () => {
  await page.goto(service.url);
  await page.locator("h1", { hasText: "Studien" }).waitFor();
  assert.equal(await page.locator("html").getAttribute("lang"), "de");
  await page.getByText("Es gibt noch keine Studie").waitFor();
  assert.deepEqual(await findings(page), []);
  assert.equal(await sideways(page), 0);
});

test("a spreadsheet becomes runs, of which some are held out and one is excluded with its reason", async () => {
  await page.getByRole("link", { name: "Neue Kalibrierung" }).first().click();
  await page
    .locator('input[type="file"]')
    .setInputFiles({ name: "Messung_Sand.xlsx", mimeType: "application/octet-stream", buffer: await readFile(FILE) });
  await page.getByText("Die Spalten von Messung_Sand.xlsx").waitFor();
  await fill("Rad aller Zeilen", "w");
  await fill("Boden aller Zeilen", "s");
  await fill(`${RADIUS} aller Zeilen`, "125");
  await page.getByLabel(`Einheit von ${RADIUS}`, { exact: true }).selectOption("mm");
  await shot(page, "german-import");
  await page.setViewportSize({ width: 400, height: 800 });
  const widths = page.locator(".mapping .scroll").evaluateAll((all) => all.map((e) => e.scrollWidth - e.clientWidth));
  assert.deepEqual(await widths, [0, 0], "tables of the import are wider than a narrow screen");
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.getByRole("button", { name: "Diese 40 Fahrten verwenden" }).click();
  await page.getByText("Fahrten: 24 angepasst, 16 zurückgehalten, 0 ausgeschlossen").click();
  await page.getByRole("button", { name: "Jede vierte Fahrt zurückhalten" }).click();
  await page.getByText("Fahrten: 30 angepasst, 10 zurückgehalten, 0 ausgeschlossen").waitFor();
  const [, first] = await page
    .getByRole("region", { name: "Fahrten des Entwurfs" })
    .locator("tbody th")
    .allTextContents();
  await page.getByLabel(`Verwendung der Fahrt ${first}`, { exact: true }).selectOption("excluded");
  const name = await page
    .getByRole("region", { name: "Fahrten des Entwurfs" })
    .locator("tbody th")
    .first()
    .evaluate(linesOf);
  assert.equal(name, 1, "the name of a run breaks");
  const reason = page.getByLabel(`Grund bei Fahrt ${first}`, { exact: true });
  await reason.pressSequentially("Kraftmessdose verrutscht");
  await reason.press("Tab");
  assert.equal(await reason.inputValue(), "Kraftmessdose verrutscht");
  await page.getByText("Fahrten: 29 angepasst, 10 zurückgehalten, 1 ausgeschlossen").waitFor();
  assert.deepEqual(await findings(page), []);
  assert.equal(await sideways(page), 0);
  await shot(page, "german-runs");
});

test("wheel, noise and limits are typed with decimal commas", async () => {
  await fill("Radius des Rades w [mm]", "125,0");
  await fill("Breite des Rades w [mm]", "112");
  await fill("Rauschen von Zugkraft [N]", "-1");
  await page.getByRole("button", { name: "experiment.toml und job.toml schreiben" }).click();
  await page.getByText("Rauschen von Zugkraft: eine Zahl größer als 0, oder nichts").waitFor();
  await fill("Rauschen von Zugkraft [N]", "1,2");
  await fill("Rauschen von Drehmoment [N m]", "0,15");
  await fill("Rauschen von Einsinkung [mm]", "0,4");
  await fill("Radlast mindestens [N]", "40");
  await page.getByLabel("höchstens [N]", { exact: true }).fill("150");
  await shot(page, "german-rig");
  await page.getByRole("button", { name: "experiment.toml und job.toml schreiben" }).click();
  const experiment = await page.getByLabel("Text von experiment.toml").inputValue();
  assert.match(experiment, /drawbar_pull_n = 1\.2\ntorque_n_m = 0\.15\nsinkage_m = 0\.0004/);
  assert.match(experiment, /\[rig\]\nwheel_load_range_n = \[40, 150\]/);
  await page.getByRole("button", { name: "Prüfen, mit den Kosten" }).click();
  const check = page.getByRole("region", { name: "Was der Job tun wird" });
  await check.getByText("29 angepasste Fahrten mit 87 Messungen, 10 zurückgehalten").waitFor();
  await check.getByText(/^(Etwa|Mehr als) [\d\s]+ Auswertungen zu je 58 Simulationen: .* auf einem Kern/).waitFor();
  await check.getByText("density_kg_m3 unter [soil.s] brächte einer Suche weitere Kandidaten").first().waitFor();
  assert.deepEqual(await findings(page), []);
  assert.equal(await sideways(page), 0);
  await shot(page, "german-check");
  await fill("Autor", "Zoë Meyer");
  await fill("Schlagwörter", "Sand, Rinne 2");
  await page.getByRole("button", { name: "Kalibrierung starten" }).click();
  await page.waitForURL(/studies\/\d+\/live/);
  const study = await service.finished(studyOf(page), STUDY_MS);
  assert.equal(study.state, "finished");
  assert.deepEqual(study.details, { name: null, author: "Zoë Meyer", tags: ["Sand", "Rinne 2"], note: null });
  const files = await service.get(`/v1/experiments/${study.experiment}`);
  assert.match(files.files["runs.csv"], /^# excluded: Kraftmessdose verrutscht; run: /m);
  const loads = (
    await service.get(`/v1/calibrations/${study.members.find((m) => m.kind === "search").id}/discovery`)
  ).information.map((run) => run.wheel_load_n);
  assert.ok(loads.length > 0 && loads.every((load) => load >= 40 && load <= 150), `${loads}`);
});

test("the result is read in German, and printed on two pages", async () => {
  await page.locator(".heading .state.finished").waitFor({ timeout: STUDY_MS });
  assert.equal(await page.locator(".heading .state").textContent(), "fertig");
  await page.getByRole("link", { name: "Das Ergebnis lesen" }).click();
  await page.getByRole("region", { name: "Was gefunden wurde" }).locator(".plot svg").waitFor();
  await page.getByText("Autor: Zoë Meyer").waitFor();
  assert.deepEqual(await findings(page), []);
  const result = await page.locator("section.view.story").textContent();
  assert.doesNotMatch(result, /\b(the|are|is|with|missing|noise|held-out|residuals)\b/);
  assert.doesNotMatch(result, /\d\.\d/);
  await shot(page, "german-story");
  await page.getByRole("link", { name: "Vorhersage", exact: true }).click();
  await page.getByText(/Bei dieser Bedingung gerechnet, mit \d+ Ziehungen/).waitFor();
  await fill("Grenze [N]", "5,5");
  await page.locator("p.answer b").waitFor();
  assert.deepEqual(await findings(page), []);
  await shot(page, "german-predict");
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Bericht speichern" }).click();
  const report = await open({ url: pathToFileURL("/").href, locale: "de-DE" });
  try {
    const path = `${await (await saved).path()}.html`;
    await (await saved).saveAs(path);
    await report.page.goto(pathToFileURL(path).href);
    await report.page.locator("section#trust").waitFor();
    await report.page.getByRole("link", { name: "Wo es versagt" }).first().waitFor();
    await report.page.evaluate(() => document.body.classList.add("brief"));
    const pdf = (await report.page.pdf({ format: "A4" })).toString("latin1");
    assert.equal(pdf.match(/\/Type \/Page\b/g)?.length, 2);
    assert.deepEqual(report.faults, []);
  } finally {
    await report.close();
  }
});

/** English texts of the page with a German form of their own; a part that varies stands for any words. */
const ENGLISH = Object.entries(GERMAN)
  .filter(([english, german]) => english !== german && /\p{L}{4}/u.test(english.replace(/\{\d\}/g, "")))
  .map(
    ([english]) =>
      new RegExp(
        `^${english
          .replace(/[.*+?^$()|[\]\\]/g, "\\$&")
          .replace(/\{\d\}/g, ".+?")
          .replace(/[{}]/g, "\\$&")}$`,
        "u",
      ),
  );
/** Sentences of the service, which stay English, and names as they are written in files. */
const OF_SERVICE = /^\w+_\w+|\.$|^it changes nothing at|(is|are) not stated; |^\d+ fitted runs with/;

/** Texts and labels that a person sees or hears, with everything unfolded. */
const textsOfPage = () =>
  page.evaluate(() => {
    for (const details of document.querySelectorAll("details")) details.open = true;
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const texts = [];
    while (walker.nextNode())
      if (!walker.currentNode.parentElement.closest("pre, code, script, style, [lang]:not(html)"))
        texts.push(walker.currentNode.data);
    for (const element of document.querySelectorAll("[aria-label], [title], [placeholder]")) {
      for (const name of ["aria-label", "title", "placeholder"]) texts.push(element.getAttribute(name) ?? "");
    }
    return [...new Set(texts.map((text) => text.trim().replace(/\s+/g, " ")).filter((text) => /\p{L}{4}/u.test(text)))];
  });

test("no view shows an English text that the catalogue has in German", async () => {
  const study = studyOf(page);
  const places = [
    "story",
    "compare",
    "failures",
    "effects",
    "posterior",
    "predict",
    "decide",
    "errors",
    "trust",
    "live",
  ].map((view) => `studies/${study}/${view}`);
  for (const place of ["", "new", ...places]) {
    await page.goto(`${service.url}/#/${place}`);
    await page.locator("main h1, main h2, section.view").first().waitFor();
    await page.locator('[aria-busy="true"]').first().waitFor({ state: "detached" });
    const texts = await textsOfPage();
    const english = texts.filter((text) => !OF_SERVICE.test(text) && ENGLISH.some((pattern) => pattern.test(text)));
    assert.deepEqual(english, [], place);
  }
});

test("a switch changes the language, the units and the slips, and keeps them", async () => {
  await page.getByRole("link", { name: "Ergebnis", exact: true }).click();
  await page.getByLabel("Sprache", { exact: true }).selectOption("en");
  await page.locator("h2", { hasText: "What to do next" }).waitFor();
  await page.getByLabel("Units", { exact: true }).selectOption("lbf, in, psi");
  await page.getByLabel("Slip as").selectOption("30 %");
  await page.getByRole("link", { name: "Compare", exact: true }).click();
  await page.locator('[data-figure*="drawbar"] .plot svg').first().waitFor();
  const words = await page.locator('[data-figure*="drawbar"]').first().textContent();
  assert.match(words, /drawbar pull \[lbf\]/);
  assert.match(words, /slip \[%\]/);
  await page.reload();
  await page.locator('[data-figure*="drawbar"] .plot svg').first().waitFor();
  assert.equal(await page.getByLabel("Units", { exact: true }).inputValue(), "lbf, in, psi");
});

test("what a study found is seen in the list without scrolling it sideways", async () => {
  await page.getByLabel("Language", { exact: true }).selectOption("de");
  await page.getByRole("link", { name: "Studien", exact: true }).click();
  const found = page.locator("td[data-label=gefunden] .found").first();
  await found.waitFor();
  const box = await found.boundingBox();
  assert.ok(box.x + box.width <= 1280, `${box.x + box.width} px`);
  assert.equal(await sideways(page), 0);
});

test("nothing went wrong on the way", () => assert.deepEqual(tab.faults, []));
