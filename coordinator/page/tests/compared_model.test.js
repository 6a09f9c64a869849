import assert from "node:assert/strict";
import { test } from "node:test";

import { comparedModels, leftOutWords } from "../modules/words/compared_model.js";

const errors = (/** @type {number} */ sds) => ({
  drawbar_pull: { rmse: 2.5 },
  sinkage: { rmse: 0.00077 },
  all: { rmse_fixed_sigma: sds },
});
const model = (/** @type {number} */ calibration, /** @type {object} */ more) => ({
  calibration,
  name: `model ${calibration}`,
  kind: "quasi_static",
  effects: [],
  log_evidence: -196.646,
  log_evidence_se: 0.0112,
  probability: 1e-13,
  chi_square_p: 1e-20,
  left_out_by: "holdout",
  left_out: errors(4.49),
  log_predictive: null,
  ...more,
});
const best = {
  log_evidence: 47.204,
  log_evidence_se: 0.02,
  probability: 0.9999999,
  chi_square_p: 0.88,
  left_out: errors(0.85),
};
const comparison = (/** @type {object} */ more = {}, /** @type {object} */ ofBest = {}) => ({
  models: [model(1, {}), model(2, { ...best, ...ofBest })],
  prior: 0.5,
  best: 2,
  best_predicting: 2,
  none_of_these: false,
  text: "",
  ...more,
});
const cell = (/** @type {any} */ table, /** @type {number} */ row, /** @type {string} */ column) =>
  table.rows[row][table.head.indexOf(column)];

test("the most probable model comes first, with its evidence, error and what is decided", () => {
  const { head, rows } = comparedModels(comparison());
  assert.deepEqual(head, [
    "model",
    "ln evidence",
    "probability",
    "p of chi-square",
    "pull [N]",
    "sinkage [mm]",
    "noise sds",
    "answer",
  ]);
  assert.deepEqual(rows, [
    ["model 2", "47.204 ± 0.020", "> 0.999", "0.88", "2.50", "0.77", "0.85", "chosen; predicts best"],
    ["model 1", "−196.646 ± 0.011", "< 0.001", "< 0.001", "2.50", "0.77", "4.49", "244 nats less"],
  ]);
});

test("none of these is an answer, and so is that it cannot be said", () => {
  const none = comparedModels(comparison({ none_of_these: true, best_predicting: 1 }));
  assert.equal(cell(none, 0, "answer"), "most probable, yet none of these");
  assert.equal(cell(none, 1, "answer"), "244 nats less; predicts best");
  const unknown = comparedModels(comparison({ none_of_these: null }, { chi_square_p: null, left_out: errors(0.85) }));
  assert.equal(cell(unknown, 0, "answer"), "chosen; none of these cannot be said; predicts best");
  assert.equal(cell(unknown, 0, "p of chi-square"), "–");
});

test("a model without evidence or without left-out data has none of their numbers", () => {
  const bare = comparison({
    models: [model(1, { log_evidence: null, log_evidence_se: null, probability: 0, left_out: null }), model(2, best)],
  });
  assert.deepEqual(comparedModels(bare).rows[1], ["model 1", "–", "< 0.001", "< 0.001", "–", "–", "–", "no evidence"]);
});

test("which data the errors are of is said", () => {
  assert.match(leftOutWords(comparison()), /held-out runs/);
  const condition = comparison({
    models: [model(1, { left_out_by: "condition" }), model(2, { left_out_by: "condition" })],
  });
  assert.match(leftOutWords(condition), /each condition/);
});
