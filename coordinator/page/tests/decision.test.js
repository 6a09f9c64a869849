import assert from "node:assert/strict";
import { test } from "node:test";

import { loss, lossWithError, significant } from "../modules/words/decision.js";

test("losses have the digits of the terminal", () => {
  assert.deepEqual([12345.6, 123456, 1264.2, 0, null].map(loss), ["12350", "123500", "1264", "0", "–"]);
  assert.equal(significant(0.00034, 2), "0.00034");
  assert.equal(significant(2.5e8, 3), "2.50·10⁸");
  assert.equal(lossWithError({ expected_loss: -12345.6, expected_loss_se: 0.00034 }), "−12350 ± 0.00034");
});
