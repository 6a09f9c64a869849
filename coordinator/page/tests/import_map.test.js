import assert from "node:assert/strict";
import { test } from "node:test";

import { byField, mapOf, meaningsOf, proposed, withAgain, without, words } from "../modules/import_map.js";

const field = (/** @type {string} */ name, /** @type {object} */ more = {}) => ({
  name,
  units: [],
  is_needed: false,
  column: null,
  unit: null,
  formula: null,
  ...more,
});
const GUESS = {
  sheet: 'Messung "1"',
  title_line: 3,
  unit_line: null,
  decimal: ",",
  fields: [
    field("wheel", { is_needed: true }),
    field("slip", { is_needed: true, units: ["1", "%"], formula: "1 - sled_speed_m_s / (omega * r)" }),
    field("sinkage_m", { units: ["m", "mm"], column: "Einsinkung" }),
    field("pass"),
  ],
  quantities: [field("r", { units: ["m", "mm"] })],
};

test("what is open is a question in the map, and what is absent is left out", () => {
  assert.equal(
    mapOf(GUESS, proposed(GUESS)),
    `sheet = "Messung \\"1\\""
titles = 3
decimal = ","

[columns.wheel]
value = "?"

[columns.slip]
formula = "1 - sled_speed_m_s / (omega * r)"

[columns.sinkage_m]
column = "Einsinkung"
unit = "?"

[quantities.r]
value = "?"
unit = "?"
`,
  );
});

test("answers take the place of questions, and a formula that nobody needs takes its quantities with it", () => {
  const choices = proposed(GUESS);
  choices.fields.wheel.value = "smooth";
  choices.fields.slip = { ...choices.fields.slip, column: "Schlupf", unit: "%" };
  choices.fields.sinkage_m.unit = "mm";
  const text = mapOf(GUESS, choices);
  assert.ok(!text.includes("?") && !text.includes("quantities"), text);
});

test("rows are left out and taken in again, blank cells filled down, and words have a meaning", () => {
  const guess = {
    ...GUESS,
    fields: [
      field("slip", { units: ["1", "%"], column: "Schlupf [%]", unit: "%" }),
      field("use", {
        column: "Bemerkung",
        meanings: [
          { word: "Kontrolle", count: 2, means: "holdout" },
          { word: 'neu "A"', count: 1, means: null },
        ],
      }),
    ],
    quantities: [],
  };
  const choices = without(without(proposed(guess), { line: 33, cells: ["Mittelwert"] }), { line: 9, cells: [] });
  choices.fields.slip.fillsDown = true;
  const text = mapOf(guess, choices);
  for (const part of [
    "\nskip = [9, 33]\n",
    'column = "Schlupf [%]"\nunit = "%"\nfill_down = true\n',
    'column = "Bemerkung"\nwords = { "Kontrolle" = "holdout", "neu \\"A\\"" = "?" }\n',
  ])
    assert.ok(text.includes(part), `${part} in\n${text}`);
  const again = mapOf(guess, withAgain(withAgain(choices, 33), 9));
  assert.ok(!again.includes("skip"), again);
});

test("the words of runs.csv need no meaning", () => {
  assert.deepEqual(
    meaningsOf({
      words: [
        { word: "fit", means: "fit" },
        { word: "holdout", means: "holdout" },
      ],
    }),
    {},
  );
  assert.deepEqual(meaningsOf({ words: [{ word: "x", means: null }] }), { x: "?" });
  assert.deepEqual(meaningsOf(undefined), {});
});

test("a complaint stands at its field, with its place in the file", () => {
  const complaints = [
    { file: "a.xlsx", cell: "C7", line: 7, field: "slip", message: "slip 4 must lie in [-1, 1)" },
    {
      file: "map.toml",
      line: 5,
      field: "wheel",
      message: 'wheel: value = "?" asks for an answer',
      plain: "Which wheel?",
    },
    { file: "map.toml", line: 6, field: "soil", message: 'soil: value = "?" asks for an answer' },
    { file: "a.xlsx", message: "there is no row of data" },
  ];
  const said = byField(complaints, ["slip", "wheel", "soil"]);
  assert.deepEqual(said.of("slip").map(words), ["cell C7: slip 4 must lie in [-1, 1)"]);
  assert.deepEqual(said.of("wheel").map(words), ["Which wheel?"]);
  assert.deepEqual(said.of("soil").map(words), ['value = "?" asks for an answer']);
  assert.deepEqual(said.others.map(words), ["there is no row of data"]);
});
