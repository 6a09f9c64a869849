import assert from "node:assert/strict";
import { test } from "node:test";

import { likeOf } from "../modules/part/explanations.js";
import { byChange, withGhost, withoutChange } from "../modules/words/ghost.js";

const ROWS = [
  { run: "a", channel: "drawbar_pull", error_sd: 1.2 },
  { run: "a", channel: "sinkage", error_sd: 0.0004 },
];
const CURVES = {
  data: [
    { run: "a", channel: "drawbar_pull" },
    { run: "a", channel: "sinkage" },
  ],
  base: [10, 0.005],
  effects: { slip_sinkage: [11, 0.009] },
};

test("the channels that an explanation changes most, compared with their errors, stand first", () => {
  assert.deepEqual(byChange(ROWS, CURVES, "slip_sinkage").slice(0, 2), ["sinkage", "drawbar_pull"]);
  assert.equal(byChange(ROWS, CURVES, null)[0], "drawbar_pull");
  assert.equal(byChange(ROWS, { data: null, base: null, effects: {} }, "slip_sinkage")[0], "drawbar_pull");
});

test("an explanation is a layer over the model", () => {
  assert.deepEqual(
    withGhost(ROWS, CURVES, "slip_sinkage").map(({ name, rows }) => [name, rows[1].predicted]),
    [
      ["model", undefined],
      ["slip_sinkage", 0.009],
    ],
  );
  assert.equal(withGhost(ROWS, CURVES, "none").length, 1);
});

test("an explanation that changes no prediction by a tenth of its error sd is absent", () => {
  const effects = { none: [10, 0.005], edge_loss: [10.01, 0.005001], tare: [10, 0.00506], fine: [10, 0.00502] };
  assert.deepEqual([...withoutChange(ROWS, { ...CURVES, effects })], ["edge_loss", "fine"]);
  assert.deepEqual([...withoutChange([], { ...CURVES, effects })], []);
  assert.equal(withoutChange(ROWS, undefined).size, 0);
  assert.equal(withoutChange(ROWS, { data: [], base: [], effects: { tare: [] } }).size, 0);
});

test("the data cannot tell apart what is of one class and alike in evidence", () => {
  const effects = [
    ["a", 1, 40],
    ["b", 1, 38],
    ["c", 1, 30],
    ["d", 2, 40],
  ].map(([name, kind, log_bayes_factor]) => ({ name, class: kind, log_bayes_factor }));
  assert.deepEqual(likeOf(effects, effects[0]), ["b"]);
  assert.deepEqual(likeOf(effects, effects[2]), []);
});
