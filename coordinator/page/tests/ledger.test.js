import assert from "node:assert/strict";
import { test } from "node:test";

import { places, tickLabels, textWidth } from "../modules/chart/tick_labels.js";
import { changesOfRuns, dataSets, runWords, step } from "../modules/words/ledger.js";
import { modelName } from "../modules/words/model.js";

const line = (/** @type {number} */ id, /** @type {string[]} */ effects, data_set = 1, fitted_runs = 28) => ({
  id,
  name: effects.length === 0 ? "base" : `with ${effects.join(", ")}`,
  effects,
  line: { calibration: id, data_set, fitted_runs, held_out_runs: 12 },
});

test("a step is what a line has beyond the one before it", () => {
  const [base, one, two] = [
    line(1, []),
    line(2, ["slip_sinkage"]),
    line(3, ["slip_sinkage", "slip_digging.grousered"]),
  ];
  assert.deepEqual(step(undefined, base), ["base"]);
  assert.deepEqual(step(base, one), ["+ slip_sinkage"]);
  assert.deepEqual(step(one, two), ["+ slip_digging.grousered"]);
  assert.deepEqual(step(one, line(4, [], 2, 29)), ["base", "+ 1 run"]);
  assert.deepEqual(step(one, line(4, ["adhesion"])), ["with adhesion"]);
  assert.deepEqual(step(base, { ...base, id: 5, name: "base (calibration 5)" }), ["base (calibration 5)"]);
  assert.deepEqual(step(base, line(4, [], 2, 29)), ["+ 1 run"]);
  assert.deepEqual(step(base, line(4, [], 2, 31)), ["+ 3 runs"]);
  assert.deepEqual(step(base, line(4, [], 2)), ["other runs"]);
});

test("lines over the same runs stand together, and change where the runs do", () => {
  const lines = [line(1, []), line(2, ["slip_sinkage"]), line(4, ["slip_sinkage"], 2, 29)];
  assert.deepEqual(
    dataSets(lines).map((set) => set.map(({ id }) => id)),
    [[1, 2], [4]],
  );
  assert.deepEqual(changesOfRuns(lines), [0, 0, 1]);
  assert.deepEqual(changesOfRuns([...lines, line(5, ["slip_sinkage", "adhesion"])]), [0, 0, 1, 2]);
  assert.equal(runWords(lines[2].line), "29 fitted runs, 12 held out");
});

test("a model that was calibrated on other runs is called so", () => {
  const member = (/** @type {number} */ id, /** @type {string[]} */ effects) => ({
    id,
    kind: "sample",
    name: "sand",
    effects,
  });
  const study = {
    models: null,
    members: [member(1, []), member(4, []), member(5, ["slip_digging.grousered"])],
    ledger: [line(1, []).line, line(4, [], 2, 29).line, line(5, [], 2, 29).line],
  };
  assert.deepEqual(
    study.members.map((m) => modelName(study, m)),
    ["base", "base, 29 fitted runs", "with slip_digging.grousered, 29 fitted runs"],
  );
  const twice = { ...study, members: [member(1, []), member(2, [])], ledger: [line(1, []).line, line(2, []).line] };
  assert.deepEqual(
    twice.members.map((m) => modelName(twice, m)),
    ["base (calibration 1)", "base (calibration 2)"],
  );
});

/** The names as they are drawn: pieces of a size at a place, those that slant by their ends. */
function drawn(/** @type {any} */ labels, /** @type {number} */ width, right = 30) {
  const { at } = places(labels.texts.length, labels.left, width - right);
  const slant = (-labels.rotate * Math.PI) / 180;
  return labels.texts.map((/** @type {string} */ text, /** @type {number} */ k) => {
    const wide = Math.max(...text.split("\n").map(textWidth));
    return labels.rotate === 0
      ? { from: at[k] - wide / 2, to: at[k] + wide / 2 }
      : { from: at[k] - wide * Math.cos(slant), to: at[k], depth: wide * Math.sin(slant) };
  });
}

test("names of models neither run into each other nor leave the picture", () => {
  const long = ["base"].concat(
    ["slip_digging.grousered", "drawbar_pull_gain", "shear_velocity_scale", "stress_dependent_friction.smooth"].map(
      (name) => `+ ${name}`,
    ),
    "+ 1 run",
  );
  long.splice(3, 0, "a name that a job gives to one of the models which it compares with all the others");
  for (const width of [300, 400, 520, 760, 1300]) {
    for (let count = 1; count <= long.length; count += 1) {
      const names = long.slice(0, count).map((name) => [name]);
      const labels = tickLabels({ names, width, left: 56, right: 30 });
      const boxes = drawn(labels, width);
      assert.ok(
        boxes.every(({ from, to }) => from >= 0 && to <= width),
        `${width} px, ${count} names: ${JSON.stringify(boxes)}`,
      );
      if (labels.rotate === 0) {
        assert.ok(
          boxes.slice(1).every(({ from }, k) => from > boxes[k].to),
          `${width} px, ${count} names touch`,
        );
      } else {
        // Parallel lines of text are apart by the step times the sine of their slant.
        assert.ok(
          labels.step * Math.sin((-labels.rotate * Math.PI) / 180) > 12,
          `${width} px, ${count} names: a step of ${labels.step} px`,
        );
        assert.ok(boxes.every(({ depth = 0 }) => depth < labels.bottom - 12));
      }
    }
  }
});

test("short names stand upright", () => {
  assert.equal(tickLabels({ names: [["base"], ["+ janosi_hanamoto"]], width: 420, left: 56, right: 30 }).rotate, 0);
  assert.deepEqual(
    tickLabels({ names: [["base"], ["+ adhesion", "+ 1 run"]], width: 420, left: 56, right: 30 }).texts,
    ["base", "+ adhesion\n+ 1 run"],
  );
});
