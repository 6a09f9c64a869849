import assert from "node:assert/strict";
import { test } from "node:test";

import { toGo } from "../modules/words/time_to_go.js";

test("the time to go follows from the share, and waits for some of it", () => {
  assert.equal(toGo(0.51, { share: 0.5, ms: 0 }, 10_000), "");
  assert.equal(toGo(0.5, { share: 0, ms: 0 }, 10_000), "about 10 s to go");
});
