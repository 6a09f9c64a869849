// Residuals of a history: measured minus model, where the model covers the measured times.

import assert from "node:assert/strict";
import { test } from "node:test";

import { residuals } from "../modules/chart/history_residuals.js";

test("a model at other times is interpolated, and times that it does not cover are left out", () => {
  const measured = { t_s: [1, 2, 3, 4], value: [10, 10, 10, 10], raw: [], window_s: [3, 4] };
  const history = { channel: "sinkage", unit: "m", run: "a", measured, model: [] };
  const found = residuals(history, { t_s: [1.5, 3.5], value: [4, 8] });
  assert.deepEqual(found, [
    { t: 2, value: 5 },
    { t: 3, value: 3 },
  ]);
});

test("a run without a recording has no residual", () => {
  const history = { channel: "sinkage", unit: "m", run: "a", measured: null, model: [] };
  assert.deepEqual(residuals(history, { t_s: [1], value: [1] }), []);
});
