import assert from "node:assert/strict";
import { test } from "node:test";

import { listed, ORDERS } from "../modules/words/study_order.js";

const study = (/** @type {number} */ id, /** @type {string} */ name, /** @type {number | null} */ sds, found = "") => ({
  id,
  name,
  details: { author: id === 2 ? "Zoë" : null, tags: id === 3 ? ["Rinne B"] : [] },
  state: "finished",
  model_kind: "quasi_static",
  effects: [],
  models: null,
  verdict: found ? { short: found } : null,
  error: sds === null ? null : { fit: { all: { rmse_fixed_sigma: 9 } }, holdout: { all: { rmse_fixed_sigma: sds } } },
});
const STUDIES = [
  study(1, "sand", 2.5, "slip_sinkage is missing (P 0.97)"),
  study(2, "clay", null),
  study(3, "Sand, wet", 0.9),
];
const ids = (text = "", order = "newest first") => listed(STUDIES, text, order).map(({ id }) => id);

test("a study is found by every word of its name, state, model and verdict", () => {
  assert.deepEqual(ids("sand"), [3, 1]);
  assert.deepEqual(ids("SAND slip sinkage"), [1]);
  assert.deepEqual(ids("quasi static finished"), [3, 2, 1]);
  assert.deepEqual(ids("study 2"), [2]);
  assert.deepEqual(ids("gravel"), []);
  assert.deepEqual(ids("zoë"), [2]);
  assert.deepEqual(ids("rinne"), [3]);
});

test("studies without an error stand behind the others, whichever the order of errors", () => {
  assert.deepEqual(ids("", "smallest error first"), [3, 1, 2]);
  assert.deepEqual(ids("", "largest error first"), [1, 3, 2]);
  assert.deepEqual(ids("", "by name"), [2, 1, 3]);
  assert.deepEqual(ids("", "oldest first"), [1, 2, 3]);
  assert.deepEqual(Object.keys(ORDERS)[0], "newest first");
});

test("studies are ordered by author, those without one last", () => assert.deepEqual(ids("", "by author"), [2, 3, 1]));
