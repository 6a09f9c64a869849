import assert from "node:assert/strict";
import { test } from "node:test";

import { table } from "../modules/chart/download.js";
import { separatedWords } from "../modules/words/few.js";
import { groups } from "../modules/words/group.js";
import { byWeight, flagWords } from "../modules/part/flags.js";
import { benchTest } from "../modules/words/bench_test.js";
import { clauses } from "../modules/words/clauses.js";
import { levels, levelWords } from "../modules/words/level.js";
import { followable } from "../modules/words/model.js";
import { measuredQuantities, statementOf } from "../modules/words/predicted_quantity.js";
import {
  meanAndSpread,
  parameterTitle,
  parameterValue,
  parameterValues,
  shownParameter,
} from "../modules/words/parameter.js";
import {
  digits,
  duration,
  meanAndSd,
  numberOf,
  parameterName,
  probability,
  raised,
  shown,
  size,
  tickWords,
  withSd,
} from "../modules/words/quantity.js";
import { hasErrorsBesideNoise, meanErrorSd, residualSds } from "../modules/words/residual.js";
import { progressWords } from "../modules/words/state.js";

test("a number has its significant digits, and an exponent only where it needs one", () => {
  assert.equal(digits(0.00933), "0.00933");
  assert.equal(digits(1234.5), "1235");
  assert.equal(digits(-2.5, 2), "−2.5");
  assert.equal(digits(1.234e-5), "1.2·10⁻⁵");
  assert.equal(digits(4.7e7, 2), "5·10⁷");
  assert.equal(digits(0), "0");
  assert.equal(digits(null), "–");
});

test("a tick is short, with an exponent where its number is large or small", () => {
  assert.deepEqual([0, 0.1 + 0.2, -0.95, 1500, 15e6, 9e7, -2e-5].map(tickWords), [
    "0",
    "0.3",
    "−0.95",
    "1500",
    "1.5·10⁷",
    "9·10⁷",
    "−2·10⁻⁵",
  ]);
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

/** Numbers from 0 to 1 that repeat from run to run of the test. */
function* shares(seed = 1) {
  for (let state = seed; ; yield state / 2 ** 31) state = (1103515245 * state + 12345) % 2 ** 31;
}
const named = (/** @type {number[]} */ values) => levels(values).map((level) => levelWords(level, "N"));
const repeated = (/** @type {number[]} */ values, /** @type {number} */ count) =>
  values.flatMap((value) => Array(count).fill(value));

test("settings that are repeated are a level each, however near they lie", () => {
  assert.deepEqual(named(repeated([100, 110, 120], 6)), ["100 N", "110 N", "120 N"]);
  assert.deepEqual(named(repeated([100, 103, 106], 2)), ["100 N", "103 N", "106 N"]);
  assert.deepEqual(named([...repeated([100, 110, 120, 200, 210], 4), 105]), [
    "100 N",
    "105 N",
    "110 N",
    "120 N",
    "200 N",
    "210 N",
  ]);
  // Computed from slip and speed, typed with four digits.
  assert.equal(levels([0.02, 0.020002, 0.019997, 0.022, 0.021998, 0.022]).length, 2);
});

test("readings that scatter by 3 % about five loads are one level for each", () => {
  const random = shares();
  const load = (/** @type {number} */ nominal) => nominal * (0.97 + 0.06 * /** @type {number} */ (random.next().value));
  for (const runs of [6, 12, 30]) {
    const found = levels(
      [60, 80, 100, 120, 140].flatMap((nominal) => Array.from({ length: runs }, () => load(nominal))),
    );
    assert.deepEqual(
      found.map(({ low }) => Math.round(low / 20) * 20),
      [60, 80, 100, 120, 140],
    );
    assert.ok(found.every(({ count }) => count === runs));
  }
});

test("readings about one load, and a range without gaps, are one level", () => {
  assert.deepEqual(named([58.3, 59.1, 60.4, 60.9, 61.2, 61.7]), ["58 to 62 N"]);
  assert.deepEqual(named([21.3, 22, 22.7, 23.3, 23.9, 24.6, 25.2, 26, 26.6]), ["21 to 27 N"]);
});

test("values that lie far apart are levels without a repeat", () => {
  assert.deepEqual(
    levels([60, 62, 120, 119]).map(({ low, high }) => [low, high]),
    [
      [60, 62],
      [119, 120],
    ],
  );
  assert.deepEqual(named([60, 80, 120]), ["60 N", "80 N", "120 N"]);
  assert.deepEqual(levels([]), []);
});

test("the ends of a level have the digits that tell them apart", () => {
  assert.equal(levelWords({ low: 21.3, high: 26.6 }, "N"), "21 to 27 N");
  assert.equal(levelWords({ low: 135.8, high: 144.2 }, "N"), "136 to 144 N");
  assert.equal(levelWords({ low: 0.0199, high: 0.01991 }, "mm/s", 1000), "19.9 mm/s");
  assert.equal(levelWords({ low: 0.007, high: 0.0071 }, "mm/s", 1000), "≈ 7.05 mm/s");
});

test("runs are grouped by the speed that the rig holds", () => {
  const run = (slip, wheel_load_n, sled_speed_m_s) => ({
    run: `${slip} ${wheel_load_n}`,
    wheel: "w",
    slip,
    wheel_load_n,
    sled_speed_m_s,
    slip_angle_deg: 0,
  });
  const sled = groups([run(0, 60, 0.01), run(0.5, 60, 0.01), run(0.5, 120, 0.01)]);
  assert.deepEqual(
    sled.groups.map((g) => g.rows.length),
    [2, 1],
  );
  assert.deepEqual(sled.colours, ["60 N", "120 N"]);
  const rim = groups([run(0, 60, 0.02), run(0.5, 60, 0.01), run(0.75, 60, 0.005), run(0, 60, 0.08)]);
  assert.deepEqual(
    rim.groups.map((g) => g.rows.length),
    [3, 1],
  );
  assert.deepEqual(rim.colours, ["rim 20 mm/s", "rim 80 mm/s"]);
});

test("where the wheel load has one level, colours tell the condition that has most", () => {
  const run = (/** @type {number} */ wheel_load_n, /** @type {number} */ slip_angle_deg) => ({
    run: "",
    wheel: "w",
    slip: 0.1,
    wheel_load_n,
    sled_speed_m_s: 0.01,
    slip_angle_deg,
  });
  const one = groups([0, 15, 45].flatMap((angle) => [run(60, angle), run(60, angle)]));
  assert.deepEqual(
    [one.colours, one.symbols, one.colourKey, one.single],
    [["0°", "15°", "45°"], [""], "slip_angle_deg", "60 N"],
  );
  assert.deepEqual(
    one.groups.map((g) => g.colour),
    [0, 1, 2],
  );
  const two = groups([0, 15, 45].flatMap((angle) => [run(60, angle), run(120, angle)]));
  assert.deepEqual([two.colours, two.colourKey, two.single], [["60 N", "120 N"], "wheel_load_n", null]);
});

test("numbers and units of the service are written as people write them", () => {
  assert.equal(
    raised("1500 kg/m^3 (p = 7e-7 among 9, p < 1e-12): by -0.5 and -2"),
    "1500 kg/m³ (p = 7·10⁻⁷ among 9, p < 10⁻¹²): by −0.5 and −2",
  );
  assert.equal(raised("sinkage_m = 0.062220742972120435 m and 0.0622"), "sinkage_m = 0.06222 m and 0.0622");
  assert.equal(
    raised("1.2e-7 m, 0.000000120012345 m, 123456.123456789 Pa, 0.0001234567891"),
    "1.2·10⁻⁷ m, 1.2·10⁻⁷ m, 123456 Pa, 0.0001235",
  );
  // Names and dates stay as they are.
  assert.equal(raised("next-41 of 2026-11-27, one-2e4b"), "next-41 of 2026-11-27, one-2e4b");
});

test("a sentence is taken apart at its semicolons, but not within brackets", () => {
  assert.deepEqual(clauses("a was missing (P > 0.999; robust) and is added; beyond that, nothing"), [
    "a was missing (P > 0.999; robust) and is added",
    "beyond that, nothing",
  ]);
  assert.deepEqual(clauses("one of a, b"), ["one of a, b"]);
});

test("a flag does not repeat the name of the model whose flags are listed", () => {
  assert.equal(flagWords("cmu+side_bulldozing: the data pull n", "cmu+side_bulldozing"), "the data pull n");
  assert.equal(flagWords("cmu: the data pull n", undefined), "cmu: the data pull n");
});

test("the weightiest flags stand first", () => {
  const flags = ["no_information", "chi2", "trend", "not_equilibrated", "of a later version"].map((kind) => ({ kind }));
  assert.deepEqual(
    byWeight(flags).map(({ kind }) => kind),
    ["not_equilibrated", "chi2", "trend", "no_information", "of a later version"],
  );
});

test("a run names three of the explanations that it separates", () => {
  assert.equal(separatedWords(["none", "a", "b"]), "nothing missing, a, b");
  assert.equal(separatedWords(["a", "b", "c", "d", "e"]), "a, b, c and 2 more");
});

test("a test without a rolling wheel is told apart from the line that states its result", () => {
  assert.deepEqual(
    benchTest('tare run: move the sled. Its result goes under [priors]: "a.b" = { normal = [VALUE, SD] }'),
    { what: "tare run: move the sled.", place: '[priors]: "a.b" = { normal = [VALUE, SD] }' },
  );
  assert.deepEqual(benchTest("plate test"), { what: "plate test.", place: null });
});

test("against the load, runs of one slip and speed are a line, and the colour tells the slip", () => {
  const run = (/** @type {number} */ slip, /** @type {number} */ wheel_load_n, /** @type {number} */ rim) => ({
    run: "",
    wheel: "w",
    slip,
    wheel_load_n,
    sled_speed_m_s: rim * (1 - slip),
    slip_angle_deg: 0,
  });
  const runs = [0.1, 0.4, -0.2].flatMap((slip) => [60, 90, 120].map((load) => run(slip, load, 0.02)));
  const byLoad = groups(runs, "wheel_load_n");
  assert.deepEqual(
    byLoad.groups.map((g) => g.rows.length),
    [3, 3, 3],
  );
  assert.deepEqual(byLoad.colours, ["slip −0.2", "slip 0.1", "slip 0.4"]);
  const bySpeed = groups(
    [0.01, 0.02, 0.04].map((rim) => run(0.1, 60, rim)),
    "sled_speed_m_s",
  );
  assert.deepEqual(
    bySpeed.groups.map((g) => g.rows.length),
    [3],
  );
  assert.deepEqual(bySpeed.symbols, [""]);
});

test("a table as CSV quotes what needs it", () => {
  assert.equal(
    table([
      { run: 'a "1", b', rmse: 1.5 },
      { run: "c", unit: null },
    ]),
    'run,rmse,unit\n"a ""1"", b",1.5,\nc,,\n',
  );
});

test("a parameter is shown in the unit that the service states, which its name need not repeat", () => {
  const label = (/** @type {string} */ name, /** @type {string} */ unit) => parameterTitle({ name, unit });
  assert.equal(label("xi_n_pa_m", "Pa/m"), "xi n [Pa/m]");
  assert.equal(shown("Pa/m").scale, 1);
  assert.equal(label("wheel_radius_m.smooth", "m"), "wheel radius: smooth [mm]");
  assert.equal(label("friction_angle_deg", "deg"), "friction angle [°]");
  assert.equal(label("sled_drag.drag_n_s_m", "N s/m"), "sled drag: drag [N s/m]");
  assert.equal(label("moisture.rate_per_m.grousered", "1/m"), "moisture: rate: grousered [1/m]");
  // People read a pressure, not its logarithm.
  assert.equal(label("log10_p_ref", "log10 Pa"), "p ref [kPa]");
  assert.equal(label("n", "1"), "n");
  // No unit is guessed from a name.
  assert.equal(parameterName("wheel_radius_m", null), "wheel radius m");
});

test("a logarithm is shown as its quantity, with a factor for its sd", () => {
  const pressure = shownParameter({ name: "log10_p_ref", unit: "log10 Pa" });
  assert.equal(meanAndSpread(pressure, 4.66, 0.023), "45.7 ×/÷ 1.05");
  assert.equal(meanAndSpread(pressure, 4.8, 0.46), "63.1 ×/÷ 2.88");
  assert.deepEqual(parameterValues(pressure, [4.6195, 4.6974, null], 4.66, 0.023), ["41.6", "49.8", "–"]);
  assert.equal(parameterValue({ name: "log10_p_ref", unit: "log10 Pa" }, 4.66), "45.7 kPa");
  assert.equal(meanAndSpread(shownParameter({ name: "wheel_radius_m", unit: "m" }), 0.1384, 0.0012), "138.4 ± 1.2");
});

test("residuals count in all errors that are assumed, as their band does", () => {
  const row = { measured: -3.9, predicted: -3.5, noise_sd: 0.1, error_sd: 4 };
  assert.ok(Math.abs(/** @type {number} */ (residualSds(row, "all")) + 0.1) < 1e-12);
  assert.equal(residualSds({ ...row, predicted: null }, "all"), null);
  assert.equal(residualSds({ ...row, error_sd: null }, "all"), null);
  assert.equal(meanErrorSd([row, { error_sd: 6 }, { error_sd: null }], "all"), 5);
  assert.equal(meanErrorSd([], "all"), null);
});

test("residuals count in the noise alone where the reader asks for it, and nobody is asked where noise is all", () => {
  const row = { measured: -3.9, predicted: -3.5, noise_sd: 0.1, error_sd: 4 };
  assert.ok(Math.abs(/** @type {number} */ (residualSds(row, "noise")) + 4) < 1e-12);
  assert.equal(meanErrorSd([row, { noise_sd: 0.3, error_sd: 6 }], "noise"), 0.2);
  assert.ok(hasErrorsBesideNoise([row]));
  assert.ok(
    !hasErrorsBesideNoise([
      { noise_sd: 0.1, error_sd: 0.1 },
      { noise_sd: null, error_sd: null },
    ]),
  );
});

test("a typed number has a point or a comma", () => {
  assert.equal(numberOf(" 2,5 "), 2.5);
  assert.equal(numberOf("−3.5"), -3.5);
  assert.equal(numberOf("1,234.5"), null);
  assert.equal(numberOf(""), null);
});

test("progress says where each kind of algorithm is", () => {
  const told = (/** @type {any} */ position) => progressWords({ position, evaluations: 2300, remaining_s: null });
  assert.equal(
    told({ kind: "sampler", stage: 5, tempering_exponent: 0.012, step: 1, acceptance: 0.3 }),
    "stage 5, exponent 0.012, 2300 evaluations",
  );
  assert.equal(
    told({ kind: "sampler", stage: 0, tempering_exponent: 0, step: 0, acceptance: null }),
    "stage 0, 2300 evaluations",
  );
  assert.equal(told({ kind: "fit", steps: 4 }), "step 4, 2300 evaluations");
  assert.equal(told({ kind: "evolution", generations: 7 }), "generation 7, 2300 evaluations");
  assert.equal(told({ kind: "search", rounds: 2 }), "round 2, 2300 evaluations");
});

test("the ends of an interval have the digits of their sd", () => {
  assert.deepEqual(withSd([0.9673, 1.2312, 1.111], 0.08), ["0.967", "1.231", "1.111"]);
  assert.deepEqual(withSd([8.419, 10.41, null], 0.61), ["8.42", "10.41", "–"]);
  assert.deepEqual(withSd([-0.95, 0.2], 0), ["−0.9500", "0.2000"]);
});

test("a statement is about a quantity that was measured, in SI", () => {
  const all = [
    ["drawbar_pull_n", "N"],
    ["torque_n_m", "N m"],
    ["sinkage_m", "m"],
    ["power_number", "1"],
  ].map(([name, unit]) => ({ name, unit }));
  const quantities = measuredQuantities(all, [{ channel: "torque" }, { channel: "sinkage" }]);
  assert.deepEqual(
    quantities.map(({ name }) => name),
    ["torque_n_m", "sinkage_m", "power_number"],
  );
  assert.equal(statementOf(quantities[0], ">", 3), "torque_n_m > 3");
  const metres = 12 / shown("m").scale;
  assert.equal(statementOf(quantities[1], "<", 12), `sinkage_m < ${metres}`);
  assert.equal(statementOf(quantities[1], "<", null), null);
  assert.equal(statementOf(undefined, "<", 12), null);
});

test("a campaign goes on from a finished calibration with draws, never from a fit or a search", () => {
  const member = (kind, state = "finished") => ({ id: 1, name: "m", effects: [], kind, state });
  const sample = member("sample");
  assert.equal(followable(sample, null), sample);
  assert.equal(followable(member("search"), sample), sample);
  assert.equal(followable(member("sample", "running"), sample), sample);
  assert.equal(followable(member("fit"), member("fit")), null);
  assert.equal(followable(member("search"), null), null);
});
