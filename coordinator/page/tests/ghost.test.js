import assert from "node:assert/strict";
import { test } from "node:test";

import { byChange, withGhost } from "../modules/words/ghost.js";

const ROWS = [{ run: "a", channel: "drawbar_pull", error_sd: 1.2 }, { run: "a", channel: "sinkage", error_sd: 0.0004 }];
const CURVES = { data: [{ run: "a", channel: "drawbar_pull" }, { run: "a", channel: "sinkage" }], base: [10, 0.005], effects: { slip_sinkage: [11, 0.009] } };

test("the channels that an explanation changes most, compared with their errors, stand first", () => {
  assert.deepEqual(byChange(ROWS, CURVES, "slip_sinkage").slice(0, 2), ["sinkage", "drawbar_pull"]);
  assert.equal(byChange(ROWS, CURVES, null)[0], "drawbar_pull");
  assert.equal(byChange(ROWS, { data: null, base: null, effects: {} }, "slip_sinkage")[0], "drawbar_pull");
});

test("an explanation is a layer over the model", () => {
  assert.deepEqual(withGhost(ROWS, CURVES, "slip_sinkage").map(({ name, rows }) => [name, rows[1].predicted]), [["model", undefined], ["slip_sinkage", 0.009]]);
  assert.equal(withGhost(ROWS, CURVES, "none").length, 1);
});
