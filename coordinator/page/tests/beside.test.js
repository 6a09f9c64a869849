import assert from "node:assert/strict";
import { test } from "node:test";

import { isOneCampaign, rowsBeside } from "../modules/words/beside.js";

const side = (/** @type {number} */ rmse, /** @type {number} */ mean, runs = 16) => ({
  study: { state: "finished", model_kind: "quasi_static", verdict: { short: "nothing detectable is missing" } },
  line: {
    effects: ["slip_sinkage"],
    fitted_runs: 24,
    held_out_runs: 16,
    error: { fit: null, holdout: { sinkage: { rmse, runs } } },
    parameters: { wheel_radius_m: { mean, sd: 0.0005 } },
  },
  diagnostics: { parameters: [{ name: "wheel_radius_m", unit: "m" }] },
});

test("errors and parameters stand beside each other in their units, with their difference", () => {
  const rows = new Map(rowsBeside([side(0.002, 0.128), side(0.001, 0.129)]).map(([what, ...cells]) => [what, cells]));
  assert.deepEqual(rows.get("Error of sinkage, held-out runs"), ["2.00 mm", "1.00 mm", "−50 %"]);
  assert.deepEqual(rows.get("wheel radius"), ["128.00 ± 0.50 mm", "129.00 ± 0.50 mm", "2.0 sds"]);
  assert.deepEqual(rows.get("Model"), ["quasi static with slip sinkage", "quasi static with slip sinkage", ""]);
  // Errors over other runs do not compare.
  assert.equal(
    rowsBeside([side(0.002, 0.128), side(0.001, 0.129, 12)]).find(([what]) => what.startsWith("Error"))?.[3],
    "over other runs",
  );
});

test("a study without a result has dashes", () => {
  const begun = { study: { state: "running", model_kind: null, verdict: null }, line: null, diagnostics: null };
  assert.deepEqual(
    rowsBeside([side(0.002, 0.128), begun]).map((row) => row[2]),
    ["running", "–", "unknown", "No search yet", "–", "–"],
  );
});

test("runs that share a name alone are of two campaigns", () => {
  const row = (/** @type {number} */ measured, run = "r1") => ({ run, channel: "sinkage", measured });
  assert.ok(isOneCampaign([row(1), row(2, "r2")], [row(1)]));
  assert.ok(!isOneCampaign([row(1)], [row(2)]));
  assert.ok(!isOneCampaign([row(1)], [row(1, "r2")]));
});
