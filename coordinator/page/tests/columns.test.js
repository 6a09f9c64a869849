import assert from "node:assert/strict";
import { test } from "node:test";

import { convert, guess, isRuns, number, parse, problems, text } from "../modules/columns.js";

const GERMAN = "Versuch;Radlast [kN];Schlupf %;Geschwindigkeit (mm/s);Zugkraft [N];Moment [N cm];Einsinkung mm\nA;0,1;20;8;35,2;590;5,6\nB;0,1;40;8;;660;\n";

test("a table in other columns, units and decimals becomes runs.csv", () => {
  const sheet = parse(GERMAN);
  const sources = guess(sheet);
  assert.deepEqual(problems(sheet, sources), []);
  assert.equal(text(convert(sheet, sources)),
    "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m\n" +
    "A,wheel,soil,0.2,100,0.008,35.2,5.9,0.0056\nB,wheel,soil,0.4,100,0.008,,6.6,\n");
});

test("names of runs.csv are taken as they are, in SI", () => {
  const sheet = parse("# a comment\nrun,wheel,soil,slip,wheel_load_n,sled_speed_m_s,sinkage_m\n\"a, b\",w,s,-0.5,100,0.01,0.004\n");
  assert.ok(isRuns(sheet.header));
  const cells = convert(sheet, guess(sheet));
  assert.deepEqual(cells[1], ['"a, b"', "w", "s", "-0.5", "100", "0.01", "0.004"]);
});

test("the unit is read from the name of the column", () => {
  const units = (/** @type {string} */ header) => Object.fromEntries(Object.entries(guess(parse(header))).map(([name, s]) => [name, s.unit]));
  const found = units("load_kN,sinkage_m,speed_cm_s,slip_angle_rad,torque");
  assert.deepEqual([found.wheel_load_n, found.sinkage_m, found.sled_speed_m_s, found.slip_angle_deg, found.torque_n_m], ["kN", "m", "cm/s", "rad", "N m"]);
});

test("what is missing or no number is said", () => {
  const sheet = parse("slip,load,pull\n0.1,100,3\n0.2,10x,4\n");
  const said = problems(sheet, guess(sheet));
  assert.equal(said.length, 2);
  assert.match(said[0], /^sled speed: choose a column/);
  assert.match(said[1], /"10x" in row 2 is not a number/);
});

test("numbers have a point or a comma", () => {
  assert.deepEqual(["1,5", "1.5", "−2", "", "1,000.5", "x"].map(number), [1.5, 1.5, -2, null, null, null]);
});
