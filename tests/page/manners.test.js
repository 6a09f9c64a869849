// How the page behaves: for keyboard and screen reader, in both themes, on narrow screens, towards other hosts, with tokens and files.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";

import { findings, open, shot, sideways } from "./browser.js";
import { Service, filesOf } from "./service.js";

const VIEWS = ["story", "live", "compare", "failures", "effects", "posterior", "predict", "decide", "errors", "trust"];
/** What is sent for the first view. */
const MOST_BYTES = 305_000;
let service;

before(async () => {
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
  assert.equal((await service.finished(study)).state, "finished");
});
after(() => service?.stop());

/** Does something with a tab and closes it. */
async function within(options, what) {
  const tab = await open({ url: service.url, ...options });
  try {
    await what(tab.page, tab);
  } finally {
    await tab.close();
    // First: an error of a script is why an element never comes.
    assert.deepEqual(tab.faults, []);
  }
}

/** Goes to an address and waits until nothing is loading. */
async function go(page, hash) {
  await page.goto(`${service.url}/${hash}`);
  await page.locator("#content h1").first().waitFor();
  // Only the address changes within the page: what was there before says nothing.
  const [, name] = /studies\/\d+\/(\w+)/.exec(hash) ?? [];
  if (name) await page.locator(`section.view.${name}`).waitFor();
  if (["story", "compare", "failures", "effects", "posterior", "predict", "errors"].includes(name))
    await page.locator("figure .plot > svg").first().waitFor();
  await page.locator('[aria-busy="true"]').first().waitFor({ state: "detached" });
  await page.waitForFunction(() =>
    [...document.querySelectorAll("figure .plot")].every(
      (plot) => plot.firstElementChild || plot.getBoundingClientRect().width === 0,
    ),
  );
}

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 1280],
  ["light", 400],
  ["dark", 400],
]) {
  test(`every view is accessible and fits, ${theme}, ${width} px`, () =>
    within({ theme, width }, async (page) => {
      for (const hash of [
        "#/",
        "#/new",
        "#/new?example=hidden-effect",
        "#/beside/1/1",
        ...VIEWS.map((name) => `#/studies/1/${name}`),
      ]) {
        await go(page, hash);
        assert.deepEqual(await findings(page), [], hash);
        assert.equal(await sideways(page), 0, `${hash} scrolls sideways [px]`);
        const cut = await page.evaluate(() =>
          [...document.querySelectorAll(".stacked")]
            .filter((table) => table.scrollWidth > table.clientWidth + 1)
            .map((table) => table.getAttribute("aria-label")),
        );
        assert.deepEqual(width < 640 ? cut : [], [], `${hash} cuts tables`);
        await shot(page, `manners-${hash.replace(/\W+/g, "-")}-${theme}-${width}`);
      }
    }));
}

test("a policy forbids what comes from elsewhere", async () => {
  const policy = (await fetch(service.url)).headers.get("content-security-policy") ?? "";
  assert.match(policy, /default-src 'self'|default-src 'none'/);
  assert.doesNotMatch(policy, /https?:|script-src[^;]*'unsafe-inline'/);
});

test("the keyboard reaches the views, and focus shows what an explanation predicts", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/effects?model=1");
    await page.evaluate(() => document.activeElement?.blur());
    const reached = [];
    let isShown = false;
    for (let k = 0; k < 40 && !isShown; k += 1) {
      await page.keyboard.press("Tab");
      const [text, label] = await page.evaluate(() => [
        document.activeElement?.textContent?.trim() ?? "",
        document.activeElement?.getAttribute("aria-label") ?? "",
      ]);
      reached.push(text);
      isShown = label.endsWith("show what janosi_hanamoto would change");
    }
    for (const title of ["Story", "Compare", "Where it fails", "Missing effect", "Error falls"])
      assert.ok(reached.includes(title), `Tab does not reach ${title}`);
    assert.ok(isShown, "Tab does not reach the first explanation");
    await page.locator(".ghosts .ghost").first().waitFor({ state: "attached" });
  }));

test("a proxy that answers for a moment in place of the coordinator ends nothing", () =>
  within({}, async (page) => {
    let isAway = true;
    await page.route("**/v1/studies", (route) =>
      isAway ? route.fulfill({ status: 502, body: "Bad Gateway" }) : route.continue(),
    );
    await page.goto(service.url);
    await page.getByText("Bad Gateway").first().waitFor();
    isAway = false;
    await page.getByRole("link", { name: "hidden" }).first().waitFor();
    // An answer that breaks off is none either.
    let isBroken = true;
    await page.route("**/v1/studies", (route) =>
      isBroken ? route.fulfill({ status: 200, contentType: "application/json", body: '[{"id": 1' }) : route.continue(),
    );
    await page.getByText("the coordinator does not answer").first().waitFor();
    isBroken = false;
    await page.getByText("the coordinator does not answer").first().waitFor({ state: "detached" });
  }));

test("an address that is mistyped says so", () =>
  within({}, async (page) => {
    for (const hash of ["#/%E0%A4%A", "#/studies/abc"]) {
      await page.goto(`${service.url}/${hash}`);
      await page.getByText("There is no such page").waitFor();
    }
  }));

test("a picture is saved as SVG, PNG and CSV", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/compare");
    const figure = page.locator("figure").first();
    const begins = { SVG: /^<svg/, PNG: /^.PNG/s, CSV: /^model,run,/ };
    for (const [kind, first] of Object.entries(begins)) {
      const [download] = await Promise.all([
        page.waitForEvent("download"),
        figure.getByRole("button", { name: kind }).click(),
      ]);
      const content = await readFile(await download.path(), "latin1");
      assert.match(content, first);
      assert.ok(content.length > 500, `${kind} has ${content.length} bytes`);
      // A slide has no page around the picture.
      if (kind === "SVG")
        for (const words of ["drawbar pull, measured and computed, by slip", "held out", "rim 10 mm/s"])
          assert.ok(content.includes(words), words);
    }
  }));

test("a list of many studies is found by words, in an order", () =>
  within({}, async (page) => {
    await page.route("**/v1/studies", async (route) => {
      const response = await route.fetch();
      const [study] = await response.json();
      const named = ["sand", "clay", "gravel", "silt"].map((name, k) => ({ ...study, id: 10 + k, name }));
      await route.fulfill({ response, json: [study, ...named] });
    });
    await page.goto(service.url);
    const names = () => page.locator("a.study-name").allTextContents();
    await page.getByText("5 studies").waitFor();
    assert.deepEqual(await names(), ["silt", "gravel", "clay", "sand", "hidden"]);
    await page.getByLabel("Order").selectOption("by name");
    await page.waitForFunction(() => document.querySelector("a.study-name")?.textContent === "clay");
    await page.getByLabel("Find").fill("gravel finished");
    await page.getByText("1 of 5 studies").waitFor();
    assert.deepEqual(await names(), ["gravel"]);
    assert.match(await page.locator("th time").first().textContent(), /^20\d\d-\d\d-\d\d$/);
    assert.match(
      await page.locator("td[data-label=found]").first().textContent(),
      /janosi_hanamoto was missing \(P\s>\s0\.999\) and is added/,
    );
  }));

test("the pictures of a view are one stop of the tab key each, and arrows go between their files", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/compare");
    const bar = page.locator("figure .downloads").first();
    assert.deepEqual(
      await bar.locator("button").evaluateAll((all) => all.map((button) => button.tabIndex)),
      [0, -1, -1],
    );
    await bar.getByRole("button", { name: "SVG" }).focus();
    for (const name of ["PNG", "CSV", "SVG"]) {
      await page.keyboard.press("ArrowRight");
      assert.equal(await page.evaluate(() => document.activeElement?.textContent), name);
    }
  }));

/** Leaves a view that is scrolled by 150 pixels for another one. */
async function leaveScrolled(page) {
  await go(page, "#/studies/1/compare");
  await page.evaluate(() => scrollTo(0, 150));
  await page.waitForFunction(() => history.state?.top === 150);
  await page.getByRole("link", { name: "Where it fails", exact: true }).click();
  await page.locator("section.view.failures figure .plot > svg").first().waitFor();
}

test("a view that is gone back to is where the reader left it", () =>
  within({ height: 600 }, async (page) => {
    await leaveScrolled(page);
    assert.equal(await page.evaluate(() => scrollY), 0);
    await page.goBack();
    await page.waitForFunction(() => Math.abs(scrollY - 150) < 3);
  }));

test("a slow machine finds the place of a view that is gone back to", () =>
  within({ height: 600 }, async (page) => {
    await leaveScrolled(page);
    const session = await page.context().newCDPSession(page);
    await session.send("Emulation.setCPUThrottlingRate", { rate: 40 });
    await page.goBack();
    await page.waitForFunction(() => Math.abs(scrollY - 150) < 3);
    assert.equal(await page.evaluate(() => history.state.top), 150);
  }));

test("an address that changes while the page is being loaded is gone to", () =>
  within({}, async (page) => {
    await page.addInitScript(() =>
      addEventListener("DOMContentLoaded", () => {
        location.hash = "#/studies/1/compare";
      }),
    );
    await page.goto(service.url);
    await page.locator("section.view.compare figure .plot > svg").first().waitFor();
  }));

test("parts that were opened are open in a view that is gone back to, and closed in a new one", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/compare");
    await page.getByText("Table of all runs").click();
    await page.locator("details[open] table").waitFor();
    await page.waitForFunction(() => history.state?.open?.length === 1);
    await page.getByRole("link", { name: "Where it fails", exact: true }).click();
    await page.locator("section.view.failures figure .plot > svg").first().waitFor();
    await page.goBack();
    await page.locator("details[open] table").waitFor();
    assert.equal(await page.locator("details[open]").count(), 1);
    await page.getByRole("link", { name: "Story", exact: true }).click();
    await page.locator("section.view.story h1, section.view.story h2").first().waitFor();
    await page.getByRole("link", { name: "Compare", exact: true }).click();
    await page.getByText("Table of all runs").waitFor();
    assert.equal(await page.locator("details[open]").count(), 0);
  }));

test("of two folded parts with one title, the one that was opened is open in a view that is gone back to", () =>
  within({}, async (page) => {
    await page.route("**/v1/studies/1", async (route) => {
      const response = await route.fetch();
      const study = await response.json();
      const step = { kind: "discover", command: null, runs: [] };
      const steps = ["first", "second"].map((text) => ({ ...step, text, detail: `why the ${text}` }));
      for (const member of study.members) if (member.story) member.story.next.steps = steps;
      await route.fulfill({ response, json: study });
    });
    await go(page, "#/studies/1/story");
    await page.getByText("In detail").nth(1).click();
    await page.waitForFunction(() => history.state?.open?.length === 1);
    await page.getByRole("link", { name: "Compare", exact: true }).click();
    await page.locator("section.view.compare figure .plot > svg").first().waitFor();
    await page.goBack();
    await page.getByText("why the second").waitFor();
    assert.equal(await page.getByText("why the first").isVisible(), false);
    assert.equal(await page.locator("details[open]").count(), 1);
  }));

test("an address has the runs that are chosen and the effect whose curves are kept", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/failures");
    const cell = page.locator('[data-figure$="residuals"] rect[data-run]').first();
    const run = await cell.getAttribute("data-run");
    await cell.click();
    await page.waitForFunction((name) => location.hash.includes(`runs=${name}`), run);
    await page.getByRole("link", { name: "Compare", exact: true }).click();
    await page.waitForFunction(
      (name) => location.hash.includes("compare") && location.hash.includes(`runs=${name}`),
      run,
    );
    const there = page.url();
    await page.getByRole("button", { name: "Let them go" }).click();
    await page.waitForFunction(() => !location.hash.includes("runs="));
    await page.goto(there);
    await page.getByRole("complementary", { name: "Chosen runs" }).getByText(`run ${run}`).waitFor();
    await go(page, "#/studies/1/effects?model=1&effect=slip_sinkage");
    await page.locator(".ghosts .ghost").first().waitFor({ state: "attached" });
    await page.getByRole("button", { name: "show what janosi_hanamoto would change" }).click();
    await page.waitForFunction(() => location.hash.includes("effect=janosi_hanamoto"));
  }));

test("a table of runs is made when it is opened", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/compare");
    const cells = page.getByRole("region", { name: "All runs" }).locator("td");
    assert.equal(await cells.count(), 0);
    await page.getByText("Table of all runs").click();
    await cells.first().waitFor();
  }));

test("against the wheel load, runs of one slip are a line", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/compare");
    await page.getByRole("button", { name: "wheel load" }).click();
    await page.locator(".legend").getByText("slip 0.2", { exact: true }).first().waitFor();
    // Curves, where straight lines would have kinks.
    await page.getByRole("button", { name: "slip", exact: true }).click();
    const line = page.locator('[data-figure*="drawbar"] .model path').first();
    await page.waitForFunction(() =>
      /C/.test(document.querySelector('[data-figure*="drawbar"] .model path')?.getAttribute("d") ?? ""),
    );
    assert.match(await line.getAttribute("d"), /C/);
  }));

test("a view is reached by its address", () =>
  within({}, async (page) => {
    await go(page, "#/studies/1/compare?model=1");
    await page.locator('section[aria-label="Compare"] figure').first().waitFor();
    assert.equal(await page.locator(".picker select").inputValue(), "1");
  }));

test("the first view takes little to send", () =>
  within({}, async (page) => {
    const session = await page.context().newCDPSession(page);
    await session.send("Network.enable");
    let bytes = 0;
    session.on("Network.loadingFinished", ({ encodedDataLength }) => (bytes += encodedDataLength));
    await go(page, "#/studies/1/story");
    assert.ok(bytes > 0 && bytes < MOST_BYTES, `${bytes} bytes`);
  }));

test("a token is asked for, and never part of an address", async () => {
  const guarded = await Service.start({ tokenOf: "ann" });
  const tab = await open({ url: guarded.url });
  try {
    await tab.page.goto(guarded.url);
    await tab.page.getByLabel("Token").fill(guarded.token);
    assert.deepEqual(await findings(tab.page), []);
    await tab.page.getByRole("button", { name: "Use it" }).click();
    await tab.page.getByText("There is no study yet").waitFor();
    assert.equal(await tab.page.getByLabel("Token").count(), 0);
    assert.ok(!tab.requests.some((url) => url.includes(guarded.token)), "the token is in an address");
    assert.ok(!tab.page.url().includes(guarded.token));
    assert.deepEqual(tab.faults, []);
  } finally {
    await tab.close();
    await guarded.stop();
  }
});
