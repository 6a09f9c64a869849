// The library of laws: what a search found is added by clicking, and the first page says where each law held.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { findings, open } from "./browser.js";
import { Service, filesOf } from "./service.js";

let service, tab, page, experiment, toml;

before(async () => {
  service = await Service.start();
  const files = await filesOf("tests/data/outside-the-catalogue");
  const texts = Object.fromEntries(files.map(({ name, text }) => [name, text]));
  const runs = { "runs.csv": texts["runs.csv"] };
  experiment = await service.post("/v1/experiments", { toml: texts["experiment.toml"], files: runs });
  toml = `${texts["job.toml"]}algorithm = "lm"\n[discovery]\napply = "ask"\n`;
  await searched("first", toml);
  tab = await open({ url: service.url });
  page = tab.page;
});
after(async () => {
  await tab?.close();
  await service?.stop();
});

/** Submits the job on the measurements and waits until its search is over. */
async function searched(name, job) {
  const { study } = await service.post("/v1/calibrations", { experiment: experiment.id, toml: job, files: {}, name });
  // The search begins a moment after the calibration ends.
  for (let rounds = 0; rounds < 600; rounds += 1) {
    const { members } = await service.finished(study);
    if (members.length > 1) return;
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.fail(`study ${study} is not searched`);
}

const opened = async () => {
  await page.goto(`${service.url}/#/`);
  await page.reload();
  await page.getByText("Library of laws").click();
};

test("the library is empty at first, and says how a law joins it", async () => {
  await opened();
  await page.getByText("No law has joined the library").waitFor();
});

test("the formulas of a law stand in classes, and the law joins the library", async () => {
  await page.goto(`${service.url}/#/studies/1/effects`);
  const table = page.getByRole("region", { name: "Formulas of the law" });
  await table.waitFor();
  assert.match(await table.textContent(), /tau \*/);
  assert.ok((await table.getByRole("button", { name: "Add this formula" }).count()) > 0);
  await page.getByRole("button", { name: "Add to the library" }).click();
  await page.getByText("is tried by every search from now on").waitFor();
  assert.deepEqual(await findings(page), []);
});

test("a later study says whether the law held, and the law can be removed", async () => {
  // The same measurements again: they found the law, so they do not count.
  await searched("second", toml.replace("seed = 1", "seed = 2"));
  await opened();
  await page.getByText("No study counts as evidence yet.").waitFor();
  const row = page.getByRole("region", { name: "Studies that tried the law" }).locator("tbody tr");
  assert.match(await row.textContent(), /second\s*held.*no: its measurements count elsewhere/s);
  await page.getByRole("button", { name: /^Remove .+ from the library$/ }).click();
  await page.getByText("No law has joined the library").waitFor();
});
