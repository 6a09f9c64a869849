import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { changed, key, meanSetting, predict, ranges, rmse } from "../modules/response_surface.js";

// The surface and its values as the service computes them (coordinator/result/src/response_surface/surface.rs).
const { surface, settings } = JSON.parse(readFileSync(new URL("response_surface.json", import.meta.url), "utf8"));

test("the page evaluates a surface as the service does", () => {
  assert.equal(settings.length, 3);
  for (const { values, outputs, distance } of settings) {
    const found = predict(surface, values);
    assert.ok(Math.abs(found.distance - distance) < 1e-12, `${found.distance}, not ${distance}`);
    surface.outputs.forEach((/** @type {any} */ output, /** @type {number} */ k) => {
      const value = /** @type {number} */ (found.outputs.get(key(output)));
      assert.ok(
        Math.abs(value - outputs[k]) < 1e-11 * (1 + Math.abs(outputs[k])),
        `${key(output)}: ${value}, not ${outputs[k]}`,
      );
    });
  }
});

test("the posterior mean lies among the draws, and a far setting beyond them", () => {
  const mean = meanSetting(surface);
  const near = predict(surface, mean);
  assert.ok(!near.isBeyond && near.distance < 1e-6, `${near.distance}`);
  const far = mean.map((value, k) => value + 9 * (surface.parameters[k].upper - surface.parameters[k].lower));
  assert.ok(predict(surface, far).isBeyond);
});

test("the ranges of an output hold its value at the mean", () => {
  const mean = predict(surface, meanSetting(surface)).outputs;
  for (const [name, [least, greatest]] of ranges(surface)) {
    const value = /** @type {number} */ (mean.get(name));
    assert.ok(least <= value && value <= greatest && Number.isFinite(greatest - least), name);
  }
});

test("parameters that follow take the place that the draws have on average", () => {
  const parameter = { logarithmic: false, centre: 0, mean: 0, lower: -10, upper: 10, unit: "1" };
  // The covariance is [[4, 2], [2, 2]]: the second parameter changes by half as much as the first.
  const pair = {
    degree: "linear",
    radius: 3,
    factor: [[2], [1, 1]],
    outputs: [],
    parameters: [
      { ...parameter, name: "a" },
      { ...parameter, name: "b", upper: 1 },
    ],
  };
  const moved = (/** @type {number} */ index, /** @type {number} */ value, /** @type {boolean} */ follows) =>
    changed(/** @type {any} */ (pair), [0, 0], index, value, follows);
  assert.deepEqual(moved(0, 1, false), [1, 0]);
  assert.deepEqual(moved(0, 1, true), [1, 0.5]);
  assert.deepEqual(moved(1, 0.5, true), [0.5, 0.5]);
  assert.deepEqual(moved(0, 6, true), [6, 1]);
});

test("measurements without an output do not count in the error", () => {
  const rows = [
    { run: "a", channel: "torque", use: "fit", measured: 5 },
    { run: "b", channel: "torque", use: "fit", measured: 1 },
    { run: "c", channel: "torque", use: "fit", measured: 9 },
  ];
  assert.equal(
    rmse(
      rows,
      new Map([
        ["torque a", 2],
        ["torque b", 5],
      ]),
    ),
    Math.sqrt(12.5),
  );
  assert.equal(rmse(rows, new Map()), null);
});
