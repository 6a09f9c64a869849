import assert from "node:assert/strict";
import { test } from "node:test";
import { axis, titled } from "../figures/axis.js";

const labels = (a) => a.ticks.map((t) => t.label);

test("ticks step by one, two or five", () => {
  assert.deepEqual(labels(axis(0, 1)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
  assert.deepEqual(labels(axis(-3, 4)), ["-3", "-2", "-1", "0", "1", "2", "3", "4"]);
  assert.deepEqual(labels(axis(11.5, 37.3)), ["15", "20", "25", "30", "35"]);
});

test("very large values leave their power of ten to the title", () => {
  const moduli = axis(-1e9, 1e9);
  assert.deepEqual(labels(moduli), ["-1.0", "-0.5", "0.0", "0.5", "1.0"]);
  assert.equal(titled("k_c", "N/m^(n+1)", moduli), "k_c [10⁹ N/m^(n+1)]");
  assert.equal(titled("n", "1", axis(0.8, 2)), "n");
  assert.equal(titled("b", "m", axis(0, 0.005)), "b [10⁻³ m]");
});

test("a value lies at its share of the pixels", () => {
  assert.equal(axis(0, 4).on(100, 0)(1), 75);
  assert.equal(axis(1, 100, { log: true }).on(0, 10)(10), 5);
  assert.deepEqual(labels(axis(1, 100, { log: true })), ["10⁰", "10¹", "10²"]);
});

test("a range without length is widened", () => {
  const point = axis(3, 3);
  assert.ok(point.low < 3 && point.high > 3);
  assert.ok(axis(0, 0).high > axis(0, 0).low);
});
