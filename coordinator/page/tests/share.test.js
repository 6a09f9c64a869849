import assert from "node:assert/strict";
import { test } from "node:test";

import { shareOf, toGo } from "../modules/words/share.js";

const at = (position, rest = {}) => shareOf({ position, evaluations: 0, step_done: 0, step_size: 100, ...rest });

test("the share rises with every algorithm and never reaches the whole", () => {
  const sampler = (tempering_exponent, step_done = 0) => at({ kind: "sampler", tempering_exponent }, { step_done });
  const pairs = [
    [sampler(0), sampler(1e-4)], [sampler(1e-4), sampler(0.3)], [sampler(0.3), sampler(1)], [sampler(1), sampler(1, 90)],
    [at({ kind: "search" }, { evaluations: 100 }), at({ kind: "search" }, { evaluations: 3000 })],
    [at({ kind: "fit", steps: 1 }), at({ kind: "fit", steps: 9 })], [at({ kind: "evolution", generations: 1 }), at({ kind: "evolution", generations: 90 })],
  ];
  for (const [early, late] of pairs) assert.ok(0 <= early && early < late && late <= 0.99, `${early} ${late}`);
});

test("the time to go follows from the share, and waits for some of it", () => {
  assert.equal(toGo(0.51, { share: 0.5, ms: 0 }, 10_000), "");
  assert.equal(toGo(0.5, { share: 0, ms: 0 }, 10_000), "about 10 s to go");
});
