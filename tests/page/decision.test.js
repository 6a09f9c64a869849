// A decision: terminal, page and report say the same numbers.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { findings, open, shot, sideways } from "./browser.js";
import { Service, coordinator, filesOf } from "./service.js";

const FILE = "examples/slope-decision/decision.toml";
const [FIRST_OPTION, OPTIONS] = [/^tested wheel, 14 deg/, 6];
let service, folder, printed, decided;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "decision-"));
  service = await Service.start();
  const files = Object.fromEntries((await filesOf("examples/hidden-effect")).map(({ name, text }) => [name, text]));
  const { id } = await service.post("/v1/experiments", {
    toml: files["experiment.toml"],
    files: { "runs.csv": files["runs.csv"] },
  });
  const { study } = await service.post("/v1/calibrations", {
    experiment: id,
    toml: files["job.toml"],
    files: {},
    name: "hidden",
  });
  const { current } = await service.finished(study);
  assert.equal(await service.get(`/v1/calibrations/${current}/decision`), null);
  printed = await coordinator("decide", FILE, String(current), "--url", service.url);
  decided = await service.get(`/v1/calibrations/${current}/decision`);
  await coordinator("report", String(current), "--url", service.url, "--output", join(folder, "report.html"));
});
after(async () => {
  await service?.stop();
  await rm(folder, { recursive: true, force: true });
});

/** The numbers of a text, in their order. */
const numbers = (text) => [...text.replaceAll("−", "-").matchAll(/-?\d+(?:\.\d+)?/g)].map(([number]) => Number(number));

/** The sentences of the terminal that begin with a word, each on one line. */
const said = (word) =>
  printed
    .replace(/\n {6,}/g, " ")
    .split("\n")
    .filter((line) => line.startsWith(word));

/** Compares what a place shows with what the terminal printed. */
async function compare(place) {
  const table = place.getByRole("region", { name: "Options of the decision" });
  await table.waitFor();
  const rows = await table
    .locator("tbody tr")
    .evaluateAll((all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
  const lines = printed.split("\n").filter((line) => /^(tested|wide) wheel, \d+ deg/.test(line));
  assert.deepEqual([rows.length, lines.length], [OPTIONS, OPTIONS]);
  assert.match(rows[0][0], FIRST_OPTION);
  rows.forEach((cells, k) => {
    // The columns of the terminal; behind them the page has the constraints.
    const shown = cells.slice(1, 6).flatMap(numbers);
    const [name] = /^.*? deg/.exec(lines[k]);
    assert.deepEqual(shown, numbers(lines[k].slice(name.length)).slice(0, shown.length), `${cells} | ${lines[k]}`);
    const { probability, needed } = decided.options[k].constraints[0];
    assert.equal(cells[6], `${probability.toFixed(2)}${probability < needed ? " too small" : ""}`);
  });
  const verdict = await place.locator(".decision .verdict").textContent();
  assert.deepEqual(numbers(verdict), numbers(said("best:")[0]), `${verdict} | ${said("best:")}`);
  // Every number of the terminal's sentences stands on the page.
  const text = await place.locator(".decision").innerText();
  const all = numbers(text);
  for (const word of ["decided:", "worth:"]) {
    const missing = said(word)
      .flatMap(numbers)
      .filter((number) => !all.includes(number));
    assert.deepEqual(missing, [], `${said(word)} | ${text}`);
  }
  const runs = await place
    .getByRole("region", { name: "Further runs" })
    .locator("tbody tr td:nth-child(6)")
    .allTextContents();
  const worth = said("run:").map((line) => numbers(line.split("is worth")[1]));
  assert.ok(worth.length > 0);
  assert.deepEqual(runs.slice(0, worth.length).map(numbers), worth);
  assert.match(text, /No further run is worth its cost\./);
}

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 400],
]) {
  test(`the page shows the decision that was asked for, ${theme}, ${width} px`, async () => {
    const tab = await open({ url: service.url, theme, width });
    const { page } = tab;
    try {
      await page.goto(`${service.url}/#/studies/1/decide`);
      await compare(page.locator("section.view.decide"));
      await page
        .locator('[data-figure$="decision"] svg circle')
        .nth(OPTIONS - 1)
        .waitFor();
      // Bars are as long as their shares.
      const widths = await page
        .getByRole("list", { name: "Shares of the variance" })
        .locator(".bar i")
        .evaluateAll((bars) =>
          bars.map((bar) => bar.getBoundingClientRect().width / bar.parentElement.getBoundingClientRect().width),
        );
      const { parameters, model, noise } = decided.decided_by;
      assert.ok(
        [parameters, model, noise].every((share, k) => Math.abs(widths[k] - share) < 0.02),
        widths.join(),
      );
      assert.deepEqual(await findings(page), []);
      assert.equal(await sideways(page), 0);
      const [download] = await Promise.all([
        page.waitForEvent("download"),
        page.locator('[data-figure$="decision"]').getByRole("button", { name: "CSV" }).click(),
      ]);
      assert.equal(download.suggestedFilename(), "hidden-decision.csv");
      await shot(page, `decision-${theme}-${width}`);
      assert.deepEqual(tab.faults, []);
    } finally {
      await tab.close();
    }
  });

  test(`the report has it offline, ${theme}, ${width} px`, async () => {
    const url = pathToFileURL(join(folder, "report.html")).href;
    const tab = await open({ url, theme, width });
    const { page } = tab;
    try {
      await page.goto(url);
      await compare(page.locator("section#decide"));
      assert.equal(await page.locator("section#decide").getByText("Decide by a file").count(), 0);
      assert.equal(await sideways(page), 0);
      assert.deepEqual(
        tab.requests.filter((asked) => !/^(file|data|blob):/.test(asked)),
        [],
      );
      assert.deepEqual(tab.faults, []);
    } finally {
      await tab.close();
    }
  });
}

test("a file that is typed decides at once, in German too", async () => {
  const tab = await open({ url: service.url, locale: "de-DE" });
  const { page } = tab;
  try {
    await page.goto(`${service.url}/#/studies/1/decide`);
    await page.getByText("Nach einer Datei entscheiden").click();
    await page
      .getByLabel("Die Entscheidung, TOML")
      .fill('[decision]\nloss = "energy_j_m"\n[[decision.options]]\nname = "nichts"\nloss = "nosuch"\n');
    const send = page.getByRole("button", { name: "Entscheiden", exact: true });
    await send.click();
    await page.getByRole("alert").getByText("1 options must be 2 to 50").waitFor();
    await page
      .getByLabel("Die Entscheidung, TOML")
      .fill(
        '[decision]\n[[decision.options]]\nname = "fahren"\ncondition = { slope_deg = 8 }\nloss = "energy_j_m"\n[[decision.options]]\nname = "bleiben"\nloss = "9000"\n',
      );
    await send.click();
    await page.getByText(/^fahren ist die beste, um/).waitFor();
    await shot(page, "decision-german");
    assert.deepEqual(tab.faults, []);
  } finally {
    await tab.close();
  }
});
