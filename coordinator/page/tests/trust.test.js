import assert from "node:assert/strict";
import { test } from "node:test";

import { judgements } from "../modules/words/trust.js";

const channel = (/** @type {string} */ name, p = 0.5) => ({ channel: name, chi_square: { p } });
const parameter = (/** @type {string} */ name, change = {}) => ({
  name,
  contraction: 0.9,
  conflict_p: 0.5,
  at_bound: false,
  ...change,
});
const wrong = (change = {}) => ({
  channels: [{ channel: "drawbar_pull", use: "holdout", is_judged: true, is_within_noise: true, ...change }],
});
const levels = (/** @type {any} */ line, /** @type {any} */ diagnostics, /** @type {any} */ of) =>
  judgements(line, diagnostics, of).map(({ level }) => level);
const GOOD = { channels: [channel("sinkage")], parameters: [parameter("n")] };

test("a calibration without faults is good by every question", () => {
  assert.deepEqual(levels({ equilibrated: true }, GOOD, wrong()), ["good", "good", "good", "good", "good"]);
  // A fit has no sampler to judge.
  assert.equal(judgements(null, GOOD, wrong()).length, 4);
});

test("each fault lowers its own question, and names what it is about", () => {
  const texts = judgements(
    { equilibrated: false },
    {
      channels: [channel("sinkage", 1e-5)],
      parameters: [parameter("n", { conflict_p: 0.001 }), parameter("kappa", { contraction: 0.02 })],
    },
    wrong({ is_within_noise: false }),
  );
  assert.deepEqual(
    texts.map(({ level }) => level),
    ["poor", "poor", "poor", "fair", "poor"],
  );
  for (const [k, name] of ["", "sinkage", "n", "kappa", "drawbar pull"].entries())
    assert.ok(texts[k].text.includes(name), texts[k].text);
  assert.deepEqual(
    levels(
      { equilibrated: true },
      { ...GOOD, parameters: [parameter("n", { at_bound: true })] },
      wrong({ use: "fit" }),
    ),
    ["good", "good", "fair", "good", "fair"],
  );
});

test("errors that are inferred from the residuals explain them in part only, and the noise is named beside them", () => {
  const channels = [{ channel: "sinkage", error_sd: 9, chi_square: { p: 0.5 } }];
  const known = { channels: [{ channel: "sinkage", use: "holdout", is_judged: true, rmse: 3, noise_sds: 4 }] };
  const [, residuals] = judgements({ equilibrated: true }, { ...GOOD, channels }, known);
  assert.equal(residuals.level, "fair");
  assert.match(residuals.text, /up to 12 times the noise: sinkage$/);
  const unknown = { channels: [{ ...known.channels[0], noise_sds: null }] };
  assert.equal(judgements({ equilibrated: true }, { ...GOOD, channels }, unknown)[1].level, "good");
});
