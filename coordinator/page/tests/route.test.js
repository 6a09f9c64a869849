import assert from "node:assert/strict";
import { test } from "node:test";

import { address, parse } from "../modules/route.js";

test("an address comes back from its text", () => {
  const to = address(["studies", 3, "compare"], { model: 5, against: null });
  assert.equal(to, "#/studies/3/compare?model=5");
  assert.deepEqual(parse(to), { place: ["studies", "3", "compare"], query: { model: "5" } });
  assert.deepEqual(parse(""), { place: [], query: {} });
  assert.deepEqual(parse(address(["a/b", "c d"])).place, ["a/b", "c d"]);
});
