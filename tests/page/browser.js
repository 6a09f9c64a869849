// Chromium, with an eye on what a page must not do: fail, log errors, ask another host, be wider than its window.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(new URL("../../coordinator/page/package.json", import.meta.url));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

/** While the coordinator is down the browser logs each request that fails. */
const DOWN = /ERR_CONNECTION|Failed to load resource/;

export async function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
}

/** A page that remembers its complaints. */
export async function open(browser, url, { width = 1280, theme = "light" } = {}) {
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme: theme, bypassCSP: true });
  page.setDefaultTimeout(60_000);
  const complaints = [];
  // A report's modules are addresses of a hundred kilobytes.
  const say = (text) => complaints.push(String(text).slice(0, 300));
  page.on("pageerror", (error) => say(error.message));
  page.on("console", (message) => message.type() === "error" && !DOWN.test(message.text()) && say(message.text()));
  page.on("request", (request) => {
    const to = new URL(request.url());
    if (/^(https?|wss?):$/.test(to.protocol) && to.origin !== new URL(url).origin) say(`asks ${to.origin}`);
  });
  await page.goto(url);
  return { page, complaints };
}

/** What a screen reader or a keyboard would stumble over. */
export async function stumbles(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
  return serious.map((v) => `${v.id}: ${v.nodes[0].html.slice(0, 200)}`);
}

/** The page is as wide as its window. */
export async function fits(page, what) {
  const [inner, outer] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(inner <= outer, `${what} is ${inner} px wide in a window of ${outer} px`);
}

/** A picture for whoever wants to look. */
export async function picture(page, name) {
  if (process.env.SCREENSHOTS) await page.screenshot({ path: join(process.env.SCREENSHOTS, `${name}.png`), fullPage: true });
}

/** Opens a view of the study by its name in the navigation. */
export async function view(page, title) {
  await page.getByRole("navigation", { name: "Views of the study" }).getByRole("link", { name: title, exact: true }).click();
  await page.getByRole("region", { name: title, exact: true }).waitFor();
}

/** Waits until the study takes no further step. */
export async function finished(page) {
  await page.locator(".heading .state.finished").waitFor({ timeout: 120_000 });
}
