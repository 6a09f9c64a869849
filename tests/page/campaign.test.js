// A campaign that is followed in the Live view: runs that are posted one by one, or typed there, change it without a reload.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { findings, open, shot, sideways } from "./browser.js";
import { Service, filesOf } from "./service.js";

const FIRST = ["0.2", "0.6"];
let service, tab, page, header, further;

before(async () => {
  service = await Service.start();
  const files = Object.fromEntries((await filesOf("examples/hidden-effect")).map(({ name, text }) => [name, text]));
  const lines = files["runs.csv"].split(/\r?\n/).filter((line) => line !== "" && !line.startsWith("#"));
  header = lines[0];
  const slip = header.split(",").indexOf("slip");
  const fitted = lines.slice(1).filter((line) => line.endsWith(",fit"));
  const isFirst = (line) => FIRST.includes(line.split(",")[slip]);
  further = fitted.filter((line) => !isFirst(line));
  const runs = [header, ...fitted.filter(isFirst)].join("\n");
  const { id } = await service.post("/v1/experiments", {
    toml: files["experiment.toml"],
    files: { "runs.csv": `${runs}\n` },
  });
  const toml = files["job.toml"].replace('apply = "auto"', 'apply = "ask"');
  const { study } = await service.post("/v1/calibrations", { experiment: id, toml, files: {}, name: "campaign" });
  await service.finished(study);
  tab = await open({ url: service.url });
  page = tab.page;
});
after(async () => {
  await tab?.close();
  await service?.stop();
});

const post = (rows) => service.post("/v1/calibrations/1/follow", { runs: `${[header, ...rows].join("\n")}\n` });
const parameters = () => page.getByRole("region", { name: "Parameters with all runs" }).locator("tbody").textContent();

test("runs that are posted one by one change posterior, models and verdict, and the next run is proposed", async () => {
  await page.goto(`${service.url}/#/studies/1/live?member=1`);
  await page.getByRole("heading", { name: "Follow a campaign" }).waitFor();
  await page.evaluate(() => {
    globalThis.isSamePage = true;
  });
  let before = "";
  for (let count = 1; count <= 3; count += 1) {
    const answer = await post(further.slice(0, count));
    const last = answer.runs.at(-1);
    await page.getByText(count === 1 ? `1 further run: ${last}` : `${count} further runs, the last ${last}`).waitFor();
    const now = await parameters();
    assert.notEqual(now, before);
    before = now;
    const models = await page.getByRole("region", { name: "Models with all runs" }).locator("tbody").textContent();
    assert.ok(models.includes(answer.models[0].weight.toFixed(3)), models);
    assert.equal((await page.locator(".next-run").count()) > 0, answer.next_runs.length > 0);
    if (answer.next_runs.length > 0)
      assert.match(
        await page.locator(".next-run").textContent(),
        /Make next: slip .*It separates .*; it settles the matter with P (<|>)? ?[01]\.\d+/,
      );
    assert.equal(await page.locator(".stop").count(), answer.stop ? 1 : 0);
  }
  // Nothing was loaded anew, and nothing is asked again and again.
  assert.equal(await page.evaluate(() => globalThis.isSamePage), true);
  assert.deepEqual(await findings(page), []);
  await shot(page, "campaign");
});

test("a run that contradicts all others is said at once", async () => {
  // The model as it is fits slips near those that it was calibrated on, so that one wrong run stands alone.
  const near = further.filter((line) => line.split(",")[header.split(",").indexOf("slip")] === "0.4");
  const cells = near[1].split(",");
  const pull = header.split(",").indexOf("drawbar_pull_n");
  cells[pull] = String(Number(cells[pull]) + 30);
  await post([near[0], cells.join(",")]);
  const alert = page.getByRole("alert").filter({ hasText: "contradicts the others" });
  await alert.waitFor();
  assert.match(
    await alert.textContent(),
    new RegExp(
      `Run ${cells[0]} contradicts the others: drawbar pull .* N, expected near .* N.*Look at sensor, preparation`,
      "i",
    ),
  );
  await shot(page, "campaign-contradiction");
});

test("a run that is typed on the page goes on with the campaign, also for others who watch it", async () => {
  const other = await open({ url: service.url, width: 400, theme: "dark" });
  try {
    await post(further.slice(0, 1));
    await page.getByText("1 further run: ").waitFor();
    await other.page.goto(`${service.url}/#/studies/1/live?member=1`);
    await other.page.getByText("1 further run: ").waitFor();
    const [titles, cells] = [header.split(","), further[1].split(",")];
    const value = (title) => Number(cells[titles.indexOf(title)]);
    const form = page.locator("form.new-runs");
    await form.getByLabel(/^slip of run 1/).fill(String(value("slip")));
    await form.getByLabel(/^wheel load of run 1 in N/).fill(String(value("wheel_load_n")));
    await form.getByLabel(/^sled speed of run 1 in mm/).fill(String(1000 * value("sled_speed_m_s")));
    await form.getByLabel(/pull of run 1 in N/).fill(String(value("drawbar_pull_n")));
    await form.getByRole("button", { name: "Follow with 1 more" }).click();
    for (const one of [page, other.page]) await one.getByText("2 further runs, the last next-").waitFor();
    assert.equal(await sideways(other.page), 0);
    assert.deepEqual(await findings(other.page), []);
    await shot(other.page, "campaign-dark-400");
    assert.deepEqual([...tab.faults, ...other.faults], []);
  } finally {
    await other.close();
  }
});
