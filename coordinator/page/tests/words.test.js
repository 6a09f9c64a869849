import assert from "node:assert/strict";
import { test } from "node:test";

import { table } from "../modules/chart/download.js";
import { groups, levels, levelWords } from "../modules/words/group.js";
import { digits, duration, meanAndSd, numberOf, parameterUnit, probability, size } from "../modules/words/quantity.js";
import { verdictWords } from "../modules/words/state.js";

test("a number has its significant digits, and an exponent only where it needs one", () => {
  assert.equal(digits(0.00933), "0.00933");
  assert.equal(digits(1234.5), "1235");
  assert.equal(digits(-2.5, 2), "−2.5");
  assert.equal(digits(1.234e-5), "1.2·10⁻⁵");
  assert.equal(digits(4.7e7, 2), "5·10⁷");
  assert.equal(digits(0), "0");
  assert.equal(digits(null), "–");
});

test("lengths are shown in millimetres", () => {
  assert.equal(size(0.00052, "m"), "0.520 mm");
  assert.equal(size(35.2, "N"), "35.2 N");
  assert.equal(size(0.25, "1"), "0.250");
});

test("mean and sd end at the second digit of the sd", () => {
  assert.deepEqual(meanAndSd(18.156, 0.1208), { mean: "18.16", sd: "0.12" });
  assert.deepEqual(meanAndSd(0.125012, 0.0000123), { mean: "0.125012", sd: "0.000012" });
});

test("a probability near its ends is a bound", () => {
  assert.equal(probability(1), "> 0.999");
  assert.equal(probability(0.9973), "0.997");
  assert.equal(probability(0.42), "0.42");
  assert.equal(probability(1e-9), "< 0.001");
});

test("durations have one unit", () => {
  assert.deepEqual([0.2, 45, 600, 9000].map(duration), ["1 s", "45 s", "10 min", "2.5 h"]);
});

test("levels lie more than 15 % apart", () => {
  assert.deepEqual(levels([60, 62, 120, 119]), [{ low: 60, high: 62 }, { low: 119, high: 120 }]);
  assert.equal(levelWords({ low: 21.3, high: 26.6 }, "N"), "21 to 27 N");
});

test("runs are grouped by the speed that the rig holds", () => {
  const run = (slip, wheel_load_n, sled_speed_m_s) => ({ run: `${slip} ${wheel_load_n}`, wheel: "w", slip, wheel_load_n, sled_speed_m_s, slip_angle_deg: 0 });
  const sled = groups([run(0, 60, 0.01), run(0.5, 60, 0.01), run(0.5, 120, 0.01)]);
  assert.deepEqual(sled.groups.map((g) => g.rows.length), [2, 1]);
  assert.deepEqual(sled.loads, ["60 N", "120 N"]);
  const rim = groups([run(0, 60, 0.02), run(0.5, 60, 0.01), run(0.75, 60, 0.005), run(0, 60, 0.08)]);
  assert.deepEqual(rim.groups.map((g) => g.rows.length), [3, 1]);
  assert.deepEqual(rim.others, ["rim 20 mm/s", "rim 80 mm/s"]);
});

test("a table as CSV quotes what needs it", () => {
  assert.equal(table([{ run: 'a "1", b', rmse: 1.5 }, { run: "c", unit: null }]), 'run,rmse,unit\n"a ""1"", b",1.5,\nc,,\n');
});

test("the name of a parameter tells its unit", () => {
  assert.equal(parameterUnit("wheel_radius_m.smooth"), "m");
  assert.equal(parameterUnit("friction_angle_deg"), "°");
  assert.equal(parameterUnit("n"), "1");
  assert.equal(parameterUnit("deflection_m_n"), "m/N");
  assert.equal(parameterUnit("drag_n_s_m"), "N s/m");
});

test("a typed number has a point or a comma", () => {
  assert.equal(numberOf(" 2,5 "), 2.5);
  assert.equal(numberOf("−3.5"), -3.5);
  assert.equal(numberOf("1,234.5"), null);
  assert.equal(numberOf(""), null);
});

test("what a study has found and added is not said to be nothing", () => {
  assert.equal(verdictWords("nothing_detectable"), "nothing detectable is missing");
  assert.equal(verdictWords("nothing_detectable", ["slip_sinkage"]), "nothing further is detectable");
  assert.equal(verdictWords("class", ["slip_sinkage"]), "an effect is missing: one of a class");
  assert.equal(verdictWords(null), "no search yet");
});
