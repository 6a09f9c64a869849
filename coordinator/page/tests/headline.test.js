import assert from "node:assert/strict";
import { test } from "node:test";

import { clearest } from "../modules/part/before_after.js";
import { errorChanges, explanations, headline, lineBefore, strengthWords } from "../modules/words/headline.js";

const errors = (/** @type {Record<string, number>} */ rmse) =>
  Object.fromEntries(Object.entries(rmse).map(([channel, value]) => [channel, { rmse: value, runs: 16 }]));
const line = (
  /** @type {number} */ calibration,
  /** @type {string[]} */ effects,
  /** @type {Record<string, number>} */ rmse,
  data_set = 1,
) => ({
  calibration,
  effects,
  data_set,
  error: { fit: errors(rmse), holdout: errors(rmse) },
});
const channel = (/** @type {string} */ name, is_within_noise = true) => ({
  channel: name,
  use: "holdout",
  is_within_noise,
});
const story = (/** @type {any} */ missing, /** @type {any[]} */ channels) => ({
  missing: { verdict: null, named: [], already_added: [], leading: [], ...missing },
  wrong: { channels },
});
const SIGMA = { drawbar_pull: { sd: 1.2, source: "declared" }, sinkage: { sd: 0.0004, source: "inferred" } };
const LEDGER = [
  line(1, [], { drawbar_pull: 11.7436, sinkage: 0.000314 }),
  line(8, ["janosi_hanamoto"], { drawbar_pull: 1.1857, sinkage: 0.000317 }),
];
const JANOSI = {
  name: "janosi_hanamoto",
  summary: "shear stress needs displacement to build up",
  probability: 0.9995,
  rivals: [],
  strengths: [{ name: "janosi_hanamoto.shear_modulus_m", unit: "m", mean: 0.009355, sd: 0.000613 }],
};

test("the headline of a repaired model says the error before and after, in the unit of the channel", () => {
  const model = {
    id: 8,
    story: story({ verdict: "nothing_detectable", already_added: [JANOSI] }, [
      channel("sinkage"),
      channel("drawbar_pull"),
    ]),
  };
  const changes = errorChanges({ ledger: LEDGER, fixed_sigma: SIGMA }, model);
  assert.equal(
    headline(model, changes),
    "Drawbar pull of held-out runs: error 11.7\u00a0→\u00a01.19\u00a0N with one more effect",
  );
  assert.deepEqual(
    changes.map(({ channel: own, noise }) => [own, noise]),
    [
      ["drawbar_pull", 1.2],
      ["sinkage", null],
    ],
  );
  assert.equal(strengthWords(JANOSI), "shear modulus 9.36 ± 0.61 mm");
});

test("a model that still lacks something says so beside what its effects bought", () => {
  const of = (/** @type {string} */ verdict) => {
    const model = { id: 8, story: story({ verdict, already_added: [JANOSI] }, [channel("drawbar_pull", false)]) };
    return headline(model, errorChanges({ ledger: LEDGER, fixed_sigma: SIGMA }, model));
  };
  assert.match(of("undecided"), /with one more effect; what else is missing is undecided$/);
  assert.match(of("named"), /with one more effect; more is missing$/);
  assert.match(of("nothing_detectable"), /with one more effect$/);
});

test("errors over other runs are no before", () => {
  assert.equal(lineBefore(LEDGER, 1), null);
  assert.equal(lineBefore(LEDGER, 8)?.calibration, 1);
  assert.equal(lineBefore([LEDGER[0], line(8, ["janosi_hanamoto"], { drawbar_pull: 1 }, 2)], 8), null);
});

test("the headline of a searched model names what is missing in plain words, or says that it is open", () => {
  const said = (/** @type {any} */ missing, isCalm = false) => {
    const model = { id: 1, story: story(missing, [channel("drawbar_pull", isCalm)]) };
    return headline(model, errorChanges({ ledger: LEDGER, fixed_sigma: SIGMA }, model));
  };
  const error = " (drawbar pull of held-out runs: error 11.7\u00a0N, noise 1.2\u00a0N)";
  assert.equal(
    said({ verdict: "named", named: [JANOSI] }),
    `Something is missing: shear stress needs displacement to build up${error}`,
  );
  assert.equal(
    said({ verdict: "class", named: [JANOSI, JANOSI] }),
    `One of 2 effects is missing, and the data do not tell which${error}`,
  );
  assert.equal(said({ verdict: "undecided" }), `Whether something is missing is undecided${error}`);
  assert.equal(
    said({ verdict: "nothing_detectable" }, true),
    `The model explains the runs to within the noise${error}`,
  );
  // Without a search, the headline begins with what the model gets wrong.
  assert.equal(
    said({}),
    "Drawbar pull of held-out runs is off by 11.7\u00a0N (noise 1.2\u00a0N); what is missing was not searched for",
  );
});

test("probabilities of one search add up to 1 with all others together", () => {
  const rival = { name: "none", summary: null, probability: 0.3 };
  const bars = explanations({ already_added: [{ ...JANOSI, probability: 0.6, rivals: [rival] }], leading: [] });
  assert.deepEqual(
    bars.map(({ summary }) => summary),
    ["shear stress needs displacement to build up", "nothing is missing", "all other explanations together"],
  );
  assert.ok(Math.abs(bars.reduce((sum, { probability }) => sum + probability, 0) - 1) < 1e-12);
  assert.deepEqual(explanations({ already_added: [], leading: [] }), []);
});

test("the picture has the load at which the models differ most", () => {
  const row = (/** @type {number} */ load, /** @type {number} */ slip, /** @type {number} */ predicted) => ({
    run: `${load} ${slip}`,
    wheel: "w",
    slip,
    wheel_load_n: load,
    sled_speed_m_s: 0.01,
    slip_angle_deg: 0,
    measured: 10,
    predicted,
  });
  const rows = (/** @type {number} */ ofHeavy) =>
    [60, 120].flatMap((load) => [0.1, 0.3, 0.5].map((slip) => row(load, slip, load === 120 ? ofHeavy : 9)));
  const found = clearest(rows(10), rows(4));
  assert.deepEqual([found.at, found.runs.size, found.wheel], ["at a wheel load of 120 N", 3, null]);
  // Where all runs have one wheel load, the picture shows one slip angle.
  const angles = (/** @type {number} */ ofSkew) =>
    [0, 45].flatMap((angle) =>
      [0.1, 0.3, 0.5].map((slip) => ({
        ...row(60, slip, angle === 45 ? ofSkew : 9),
        run: `${angle} ${slip}`,
        slip_angle_deg: angle,
      })),
    );
  assert.equal(clearest(angles(10), angles(4)).at, "at a slip angle of 45°");
  // Two slips are no curve: all runs are drawn.
  assert.equal(clearest(rows(10).slice(0, 2), rows(4).slice(0, 2)).at, null);
});
