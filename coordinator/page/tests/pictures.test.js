import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import vm from "node:vm";

// The vendored libraries are scripts that leave their names behind, as in the document.
vm.runInThisContext(readFileSync(new URL("../vendor/d3.js", import.meta.url), "utf8"));
const { natsWords, shownNats } = await import("../modules/chart/information_map.js");
const { scaleOf, ticksOf } = await import("../modules/chart/pairs.js");
const { tickWords } = await import("../modules/words/quantity.js");

test("an estimate of information below 0 is drawn and called 0 within its error", () => {
  assert.equal(shownNats(-0.0005), 0);
  assert.equal(shownNats(0.07), 0.07);
  assert.match(natsWords(-0.0005), /^0 nats within the error/);
  assert.equal(natsWords(0.071), "0.071 nats");
});

test("the axis of a parameter ends at the bounds of its prior, in the unit that is shown", () => {
  const kappa = { name: "kappa", unit: "1", bounds: [-0.95, null], mean: -0.6, sd: 0.25, q05: -0.93, q95: -0.1 };
  assert.deepEqual(scaleOf(kappa, [0, 110]).domain().map((v) => Number(v.toFixed(3))), [-0.95, 0.275]);
  const radius = { name: "wheel_radius_m", unit: "m", bounds: [0.125, 0.155], mean: 0.14, sd: 0.002, q05: 0.137, q95: 0.143 };
  assert.deepEqual(scaleOf(radius, [0, 110]).domain().map((v) => Number(v.toFixed(3))), [133, 147]);
  // A logarithm is drawn as its quantity.
  const pressure = { name: "log10_p_ref", unit: "log10 Pa", bounds: [4, 5.6], mean: 4.5, sd: 0.02, q05: 4.46, q95: 4.53 };
  const axis = scaleOf(pressure, [0, 110]);
  assert.deepEqual(axis.domain().map((v) => Number(v.toFixed(1))), [26.9, 37.2]);
  assert.ok(Math.abs(axis(10 ** 1.5) - 55) < 1e-9);
});

test("labels of ticks stay in their cell and apart", () => {
  const wide = (/** @type {string} */ text) => 5.4 * text.length;
  for (const [low, high] of [[-0.95, 0.275], [133, 147], [0.99, 1.012], [1.2e6, 9.7e6], [0, 1], [-2e-5, 3e-5], [3.31, 3.34], [41.6, 49.9], [26.9, 372]]) {
    for (const [side, kind] of [110, 180].flatMap((side) => [[side, "scaleLinear"], ...(low > 0 ? [[side, "scaleLog"]] : [])])) {
      const axis = globalThis.d3[kind]([low, high], [0, side]);
      const values = ticksOf(axis, wide);
      const ends = values.map((v) => [axis(v) - wide(tickWords(v)) / 2, axis(v) + wide(tickWords(v)) / 2]);
      assert.ok(values.length > 0, `${low} to ${high}, ${kind}: no tick`);
      assert.ok(ends.every(([from, to]) => from >= -4 && to <= side + 4), JSON.stringify(ends));
      assert.ok(ends.slice(1).every(([from], k) => from - ends[k][1] >= 4), JSON.stringify(ends));
      assert.equal(new Set(values.map(tickWords)).size, values.length, `${low} to ${high}: ${values.map(tickWords)}`);
    }
  }
});
