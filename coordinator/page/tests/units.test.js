import assert from "node:assert/strict";
import { test } from "node:test";

// A browser in which somebody has chosen.
const KEPT = { "grouser.units": "lbf, in, psi", "grouser.slip": "30 %", "grouser.language": "de" };
globalThis.localStorage = { getItem: (/** @type {string} */ key) => KEPT[key] ?? null };
const { CONDITIONS } = await import("../modules/chart/condition.js");
const { conditionWords } = await import("../modules/words/condition.js");
const { channelName, shown, size } = await import("../modules/words/quantity.js");

test("quantities are shown in the units that were chosen, and slips in per cent", () => {
  assert.deepEqual(
    ["N", "N m", "m", "Pa", "deg"].map((unit) => shown(unit).unit),
    ["lbf", "lbf ft", "in", "psi", "°"],
  );
  assert.equal(size(44.482216152605, "N"), "10,0 lbf");
  assert.equal(size(1.3558179483314, "N m"), "1,00 lbf ft");
  assert.equal(size(0.0254, "m"), "1,00 in");
  assert.deepEqual(
    CONDITIONS.map(({ unit }) => unit),
    ["%", "lbf", "in/s", "°"],
  );
  assert.equal(
    conditionWords({ slip: 0.3, wheel_load_n: 444.82216152605, sled_speed_m_s: 0.0254 }),
    "Schlupf 30 %, 100 lbf, 1,00 in/s",
  );
});

test("the words are German", () => assert.equal(channelName("drawbar_pull"), "Zugkraft"));
