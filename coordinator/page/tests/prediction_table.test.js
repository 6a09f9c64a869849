import assert from "node:assert/strict";
import { test } from "node:test";

import { atSlip, beyond, curve, curvePlan, middle, rangesOf, refused, tableOf } from "../modules/prediction_table.js";
import { reasonWords } from "../modules/words/refusal.js";

const run = (slip, load, speed) => ({ slip, wheel_load_n: load, sled_speed_m_s: speed });
/** Answers of a service whose quantity is a function of the condition. */
const answered = (plan, of) =>
  plan
    .trim()
    .split("\n")
    .slice(1)
    .map((line) => {
      const [, slip, load, speed] = line.split(",").map(Number);
      const mean = of(slip, load, speed);
      return {
        quantities: [{ name: "q", models_mean: mean, models: [0, 0], models_measurement: [mean - 1, mean + 1] }],
      };
    });
const SLIPS = [0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7];
const near = (a, b, within = 1e-9) => assert.ok(Math.abs(a - b) <= within, `${a} is not ${b}`);

/** A grid as the service answers it, of a quantity that is a function of the condition. */
const gridOf = (of) => {
  const [slips, loads, speeds] = [
    [0, 0.1, 0.3, 0.7],
    [50, 90, 150],
    [0.01, 0.02, 0.04],
  ];
  const point = (slip, load, speed) => ({
    refused: null,
    values: [[of(slip, load, speed), of(slip, load, speed) - 1, of(slip, load, speed) + 1], null],
  });
  const points = slips.flatMap((slip) => loads.flatMap((load) => speeds.map((speed) => point(slip, load, speed))));
  const quantities = [
    { name: "q", unit: "N", is_measurement: true },
    { name: "none", unit: "N", is_measurement: false },
  ];
  return {
    slips,
    wheel_loads_n: loads,
    speeds_m_s: speeds,
    quantities,
    wheels: [{ wheel: "w", points }],
    reach: { slip: [0, 0.7], wheel_load_n: [50, 150], speed_m_s: [0.01, 0.04] },
  };
};

test("what lies beyond the fitted runs is named", () => {
  const fitted = rangesOf({ slip: [0.1, 0.5], wheel_load_n: [60, 120], speed_m_s: [0.02, 0.02] });
  assert.deepEqual(beyond({ wheel: "w", slip: 0.5, load: 60, speed: 0.02 }, fitted), []);
  assert.deepEqual(beyond({ wheel: "w", slip: 0.6, load: 50, speed: 0.02 }, fitted), ["slip", "load"]);
});

test("the sliders begin at a load and a speed that were run", () => {
  const fitted = rangesOf({ slip: [0.1, 0.5], wheel_load_n: [60, 120], speed_m_s: [0.02, 0.02] });
  const rows = [run(0.1, 60, 0.018), run(0.5, 84, 0.01), run(0.5, 120, 0.01)];
  assert.deepEqual(middle(rows, fitted, true), { slip: 0.23, load: 84, speed: 0.02 });
});

test("a grid gives its own values back, and parabolas of load and speed between them", () => {
  const of = (slip, load, speed) => slip * 10 + 0.001 * load * load - 100 * speed;
  const grid = gridOf(of);
  const table = tableOf(grid, "w");
  assert.equal(tableOf(grid, "v"), null);
  const points = curve(table, "q", { load: 83, speed: 0.017 });
  assert.equal(points.length, 4);
  for (const { slip, mean, low, high, isMeasurement } of points) {
    near(mean, of(slip, 83, 0.017), 1e-9);
    near(high - low, 2);
    assert.ok(isMeasurement);
  }
  near(atSlip(points, 0.33).mean, of(0.33, 83, 0.017), 1e-9);
  assert.equal(atSlip(points, 0.8), null);
  // A quantity without any prediction has no curve; a refusal at one corner of the grid leaves the curve blank at this slip.
  assert.deepEqual(curve(table, "none", { load: 83, speed: 0.017 }), []);
  grid.wheels[0].points[0] = { refused: { draws: 40, of: 40, reason: "no_support: x" }, values: [null, null] };
  assert.equal(curve(tableOf(grid, "w"), "q", { load: 83, speed: 0.017 }).length, 3);
});

test("a curve is monotone between monotone points and goes through the slip that was asked for", () => {
  const { plan, fill, here } = curvePlan({ wheel: "w", slip: 0.123, load: 90, speed: 0.02 }, SLIPS, true);
  const of = (slip) => 20 * (1 - Math.exp(-slip / 0.05));
  const table = fill(answered(plan, of));
  assert.equal(table.slips[here], 0.123);
  // The sled falls behind the rim.
  near(Number(plan.split("\n")[here + 1].split(",")[3]), 0.02 * (1 - 0.123));
  const points = curve(table, "q", { load: 90, speed: 0.02 });
  near(atSlip(points, 0.123).mean, of(0.123), 1e-9);
  let last = -Infinity;
  for (let slip = 0; slip <= 0.7; slip += 0.01) {
    const { mean } = atSlip(points, slip);
    assert.ok(mean >= last, `falls at ${slip}`);
    last = mean;
  }
});

test("a slip that the model refuses leaves a gap", () => {
  const { plan, fill } = curvePlan({ wheel: "w", slip: 0.7, load: 90, speed: 0.02 }, SLIPS, false);
  const runs = answered(plan, (slip) => slip);
  runs[0] = { quantities: [] };
  const points = curve(fill(runs), "q", { load: 90, speed: 0.02 });
  assert.equal(points.length, SLIPS.length - 1);
  assert.equal(atSlip(points, 0), null);
});

test("an interval says whether it is that of new measurements, and a curve has one kind", () => {
  const { plan, fill } = curvePlan({ wheel: "w", slip: 0.7, load: 90, speed: 0.02 }, SLIPS, false);
  const runs = answered(plan, (slip) => slip);
  const place = { load: 90, speed: 0.02 };
  assert.ok(curve(fill(runs), "q", place).every(({ isMeasurement }) => isMeasurement));
  // One run whose noise is not known makes all intervals of the quantity those of the parameters.
  const quantity = (run, more) => ({
    quantities: [...run.quantities.map((q) => ({ ...q, ...more })), { ...run.quantities[0], name: "other" }],
  });
  const points = curve(
    fill(runs.map((run, k) => quantity(run, k === 4 ? { models_measurement: null } : {}))),
    "q",
    place,
  );
  for (const point of points) assert.deepEqual([point.isMeasurement, point.low, point.high], [false, 0, 0]);
  assert.equal(atSlip(points, 0.3).isMeasurement, false);
  const other = curve(fill(runs.map((run) => quantity(run, { models_measurement: null }))), "other", place);
  assert.equal(atSlip(other, 0.3).isMeasurement, true);
  near(atSlip(other, 0.3).high - atSlip(other, 0.3).low, 2);
});

test("slips that the model refuses are named with its reason, and a curve that has none left is known", () => {
  const { plan, fill } = curvePlan({ wheel: "w", slip: 0.7, load: 90, speed: 0.02 }, SLIPS, false);
  const refusal = {
    draws: 40,
    of: 40,
    reason: "no_support: condition 3: the soil carries at most 80 N of the 90 N wheel load",
  };
  const runs = answered(plan, (slip) => slip);
  const table = fill(runs);
  assert.equal(refused(table), null);
  const some = fill(runs.map((run, k) => (k < 2 || k === 5 ? { quantities: [], refused: refusal } : run)));
  const { spans, isWhole, refusal: found } = refused(some);
  assert.deepEqual(spans, [
    [some.slips[0], some.slips[1]],
    [some.slips[5], some.slips[5]],
  ]);
  assert.ok(!isWhole && found === refusal);
  assert.equal(curve(some, "q", { load: 90, speed: 0.02 }).length, some.slips.length - 3);
  assert.equal(reasonWords(refusal.reason), "the soil carries at most 80 N of the 90 N wheel load");
  const all = refused(fill(runs.map(() => ({ quantities: [], refused: refusal }))));
  assert.ok(all.isWhole && all.spans.length === 1);
  // A condition that is refused at few draws is predicted by the others.
  assert.equal(refused(fill(runs.map((run) => ({ ...run, refused: { ...refusal, draws: 1 } })))), null);
});
