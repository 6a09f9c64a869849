// The sliders of a model's parameters, as a person uses them: on the page and in a report alike.

import assert from "node:assert/strict";

import { findings } from "./browser.js";

/** The shapes of the curves that move. */
const shapes = (place) => place.locator(".moving path").evaluateAll((all) => all.map((path) => path.getAttribute("d")));

/** Waits until the curves are others than these, and returns them. */
async function moved(place, before) {
  await place
    .page()
    .waitForFunction(
      ([selector, old]) =>
        [...document.querySelectorAll(selector)].map((path) => path.getAttribute("d")).join() !== old,
      ["details.sliders .moving path", before.join()],
    );
  return shapes(place);
}

/** Opens the folded part within a place, moves every slider from end to end, and resets them. */
export async function moveSliders(page, count) {
  const place = page.locator("details.sliders");
  await place.locator("summary").click();
  const sliders = place.getByRole("slider");
  await place.locator(".moving path[d]").first().waitFor({ state: "attached" });
  assert.equal(await sliders.count(), count);
  const errors = place.getByRole("region", { name: "Errors at the setting of the sliders" });
  const status = place.getByRole("status");
  const [start, startErrors] = [await shapes(place), await errors.textContent()];
  assert.ok(start.length > 2 && start.every((d) => /^M[^N]*$/.test(d)), start.join());
  assert.match(startErrors, /noise sds/);
  assert.match(await status.textContent(), /^Among the draws/);
  let before = start;
  for (let k = 0; k < count; k += 1) {
    const slider = sliders.nth(k);
    const text = await slider.getAttribute("aria-valuetext");
    await slider.focus();
    await page.keyboard.press("End");
    before = await moved(place, before);
    assert.notEqual(await slider.getAttribute("aria-valuetext"), text);
  }
  assert.notEqual(await errors.textContent(), startErrors);
  assert.match(await status.textContent(), /^Beyond the draws/);
  assert.ok((await place.locator(".moving.beyond").count()) > 0);
  const dash = await place
    .locator(".moving.beyond")
    .first()
    .evaluate((curves) => getComputedStyle(curves).strokeDasharray);
  assert.notEqual(dash, "none");
  assert.deepEqual(await findings(page), []);
  await place.getByRole("button", { name: "Reset to the posterior mean" }).click();
  assert.deepEqual(await moved(place, before), start);
  assert.equal(await errors.textContent(), startErrors);
  await place.getByLabel("the others follow").check();
  await sliders.first().focus();
  await page.keyboard.press("End");
  await moved(place, start);
  assert.match(await status.textContent(), /^Among the draws/);
}
