// A report as a file: the story first, every picture, nothing asked of anybody.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { findings, open, shot, sideways } from "./browser.js";
import { coordinator } from "./service.js";
import { moveSliders } from "./sliders.js";

let folder;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "report-"));
  await coordinator("run", "examples/hidden-effect/job.toml", "--out", join(folder, "out"));
});
after(() => rm(folder, { recursive: true, force: true }));

/** Opens a report and returns the tab; each section is there. */
async function opened(file, options) {
  const url = pathToFileURL(file).href;
  const tab = await open({ url, ...options });
  await tab.page.goto(url);
  await tab.page.locator("section#trust").waitFor();
  return tab;
}

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 400],
]) {
  test(`the report tells its story without asking anybody, ${theme}, ${width} px`, async () => {
    const tab = await opened(join(folder, "out", "report.html"), { theme, width });
    const { page } = tab;
    try {
      assert.equal(await page.locator("section").first().getAttribute("id"), "story");
      for (const id of ["live", "compare", "failures", "posterior", "predict", "errors"]) {
        await page.locator(`section#${id} figure .plot svg`).first().waitFor({ state: "attached" });
      }
      assert.equal(
        await page.locator(".error").count(),
        0,
        await page
          .locator(".error")
          .first()
          .textContent()
          .catch(() => ""),
      );
      assert.deepEqual(await findings(page), []);
      assert.equal(await sideways(page), 0);
      assert.deepEqual(
        tab.requests.filter((url) => !/^(file|data|blob):/.test(url)),
        [],
      );
      assert.equal(tab.requests.filter((url) => url.startsWith("file:")).length, 1);
      assert.deepEqual(tab.faults, []);
      await shot(page, `report-${theme}-${width}`);
    } finally {
      await tab.close();
    }
  });
}

test("a summary of two pages is printed, with the story first", async () => {
  const tab = await opened(join(folder, "out", "report.html"));
  const { page } = tab;
  try {
    await page.locator("section#story figure .plot svg").first().waitFor();
    await page.locator("section#compare figure .plot svg").first().waitFor();
    assert.match(
      await page.locator("header").textContent(),
      /20\d\d-\d\d-\d\d; 24 fitted runs, 16 held out; wheel w; slip 0.05 to 0.7, load 60 to 150 N, speed 4 to 76 mm\/s; Grouser \d/,
    );
    await page.evaluate(() => {
      globalThis.print = () => document.body.classList.add("asked");
    });
    await page.getByRole("button", { name: "Print a summary" }).click();
    assert.equal(await page.locator("body.brief.asked").count(), 1);
    const pdf = await page.pdf({ format: "A4" });
    const pages = pdf.toString("latin1").match(/\/Type \/Page\b/g)?.length;
    assert.equal(pages, 2);
    assert.deepEqual(tab.faults, []);
  } finally {
    await tab.close();
  }
});

test("sliders of the parameters move the curves in the report, too", async () => {
  const tab = await opened(join(folder, "out", "report.html"), { width: 1280 });
  try {
    await moveSliders(tab.page, 5);
    assert.deepEqual(tab.faults, []);
    await shot(tab.page, "report-sliders");
  } finally {
    await tab.close();
  }
});

test("sliders of conditions move the prediction in the report, too, without asking anybody", async () => {
  const tab = await opened(join(folder, "out", "report.html"), { width: 1280 });
  const { page } = tab;
  try {
    const section = page.locator("section#predict");
    const values = section.getByRole("region", { name: "Predictions at the chosen condition" });
    const pull = async () =>
      Number(
        (await values.locator("tr", { hasText: "Drawbar pull" }).locator("td").first().textContent()).replace("−", "-"),
      );
    const [before, curve] = [await pull(), await section.locator("figure .plot svg").innerHTML()];
    await section.getByText(/Interpolated between conditions that were computed with \d+ draws/).waitFor();
    const began = await page.evaluate(() => performance.now());
    await section.getByLabel("wheel load", { exact: true }).press("End");
    await section.getByText("Beyond the fitted range in wheel load").waitFor();
    assert.ok((await pull()) > before + 1, "the pull does not follow the load");
    assert.notEqual(await section.locator("figure .plot svg").innerHTML(), curve);
    assert.ok((await page.evaluate(() => performance.now())) - began < 5000);
    assert.deepEqual(await findings(page), []);
    assert.deepEqual(
      tab.requests.filter((url) => !/^(file|data|blob):/.test(url)),
      [],
    );
    assert.deepEqual(tab.faults, []);
    await shot(page, "report-predict");
  } finally {
    await tab.close();
  }
});

test("what sliders need takes at most 400 kB of the report", async () => {
  const { readFile } = await import("node:fs/promises");
  const text = await readFile(join(folder, "out", "report.html"), "utf8");
  const answers = JSON.parse(/<script[^>]* id="answers"[^>]*>([^]*?)<\/script>/.exec(text)[1]);
  const sliders = Object.entries(answers).filter(([path]) => /response-surface$|prediction-grid$/.test(path));
  assert.ok(sliders.some(([path]) => path.endsWith("prediction-grid")));
  assert.ok(sliders.reduce((sum, [, answer]) => sum + JSON.stringify(answer).length, 0) <= 400_000);
});

test("a model of the study has a report of its own", async () => {
  const base = join(folder, "base.html");
  await coordinator("report", "1", "--out", join(folder, "out"), "--output", base);
  const tab = await opened(base);
  try {
    assert.match(await tab.page.locator("header .note").first().textContent(), /, base;/);
  } finally {
    await tab.close();
  }
});
