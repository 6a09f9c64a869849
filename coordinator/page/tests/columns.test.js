import assert from "node:assert/strict";
import { test } from "node:test";

import { isRuns, parse } from "../modules/columns.js";

test("fields are told by the separator that the titles have", () => {
  const { header, rows } = parse("\uFEFFVersuch;Radlast [kN];Zugkraft [N]\nA;0,1;35,2\n\nB;0,1;\n");
  assert.deepEqual(header, ["Versuch", "Radlast [kN]", "Zugkraft [N]"]);
  assert.deepEqual(rows, [
    ["A", "0,1", "35,2"],
    ["B", "0,1", ""],
  ]);
});

test("runs.csv is told by its names, below comments", () => {
  const { header, rows } = parse(
    '# a comment\nrun,wheel,soil,slip,wheel_load_n,sled_speed_m_s,sinkage_m\n"a, b",w,s,-0.5,100,0.01,0.004\n',
  );
  assert.ok(isRuns(header) && !isRuns(["run", "slip"]));
  assert.equal(rows[0][0], "a, b");
});
