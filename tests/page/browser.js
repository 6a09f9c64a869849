// Chromium on the page of a service, with what a page must not do: ask other hosts, print errors, scroll sideways, shut people out.

import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(new URL("../../coordinator/page/package.json", import.meta.url));
const { chromium } = require("playwright-core");
const axe = require.resolve("axe-core/axe.min.js");

/** So long a step may take before it counts as missing. */
export const STEP_MS = 60_000;

/** A browser with one page; `faults` collects requests to other hosts, errors on the console and of scripts. */
export async function open({ url, width = 1280, height = 900, theme = "light", locale = "en-GB" }) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--disable-dev-shm-usage", "--no-sandbox"],
  });
  const context = await browser.newContext({
    viewport: { width, height },
    colorScheme: theme,
    locale,
    acceptDownloads: true,
    bypassCSP: false,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(STEP_MS);
  const faults = [],
    requests = [];
  const host = url.startsWith("file:") ? "" : new URL(url).host;
  page.on("request", (request) => {
    const asked = new URL(request.url());
    requests.push(request.url());
    if (!["data:", "blob:"].includes(asked.protocol) && asked.host !== host) faults.push(`request to ${asked.host}`);
  });
  // A module of a report is a data URL: its name would fill the screen.
  const brief = (text) => text.replace(/data:\S{80,}/g, "data:…").slice(0, 300);
  // A coordinator that is killed on purpose, or that asks for a token, makes the browser itself print these.
  const isExpected = (text) => /Failed to load resource|ERR_CONNECTION|ERR_INCOMPLETE|ERR_EMPTY/.test(text);
  page.on(
    "console",
    (message) =>
      message.type() === "error" && !isExpected(message.text()) && faults.push(`console: ${brief(message.text())}`),
  );
  page.on("pageerror", (error) => faults.push(`error: ${brief(error.message)}`));
  return { browser, context, page, faults, requests, close: () => browser.close() };
}

/** Serious findings of axe-core; the styles of a page forbid injected script tags, so it is evaluated. */
export async function findings(page) {
  const { readFile } = await import("node:fs/promises");
  await page.evaluate(await readFile(axe, "utf8"));
  return page.evaluate(async () => {
    const { violations } = await globalThis.axe.run(document, { resultTypes: ["violations"] });
    return violations
      .filter((v) => ["serious", "critical"].includes(v.impact))
      .map(
        (v) =>
          `${v.id}: ${v.nodes
            .slice(0, 3)
            .map((n) => n.target.join(" "))
            .join("; ")}`,
      );
  });
}

/** How far a page scrolls sideways [px]. */
export const sideways = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Writes a picture of the page where $SCREENSHOTS names a folder. */
export async function shot(page, name) {
  if (process.env.SCREENSHOTS)
    await page.screenshot({ path: join(process.env.SCREENSHOTS, `${name}.png`), fullPage: true });
}

/** Goes to a view of the study that is open. */
export async function view(page, title) {
  await page
    .getByRole("navigation", { name: "Views of the study" })
    .getByRole("link", { name: title, exact: true })
    .click();
  await page.locator(`section[aria-label="${title}"]`).waitFor();
}

/** The number of the study that is open. */
export const studyOf = (page) => Number(page.url().match(/studies\/(\d+)/)[1]);
