// The map of an import as a person clicks it together: its text, and which field a complaint belongs to.

import { t } from "./language/language.js";

/**
 * @typedef {{ column: string | null, value: string, unit: string, formula: string, fillsDown: boolean, words:
 *   Record<string, string> }} Choice blank: absent. words: what the words of the column mean for the use of a run.
 */
/**
 * @typedef {{ line: number, cells: string[] }} Skipped a row that is left out, with its first cells where they are
 *   known
 */
/**
 * @typedef {{ sheet: string | null, titleLine: number, unitLine: number | null, decimal: string | null, skipped:
 *   Skipped[], fields: Record<string, Choice>, quantities: Record<string, Choice> }} Choices
 */

const blank = { column: null, value: "", unit: "", formula: "", fillsDown: false, words: {} };
/** What a word of a column can mean for a run, in the words of a map and of people. @type {[string, string][]} */
export const MEANINGS = [
  ["fit", t`fitted`],
  ["holdout", t`held out: never fitted`],
  ["skip", t`no run: left out`],
];
/** What is open, in a map. */
const QUESTION = "?";

/**
 * What the words of a column mean, as proposed; nothing where they are those of runs.csv.
 * @returns {Record<string, string>}
 */
export function meaningsOf(/** @type {ColumnCard | undefined} */ column) {
  const words = column?.words ?? [];
  return words.every((card) => ["fit", "holdout"].includes(card.word)) ? {} : tableOf(words);
}

const tableOf = (/** @type {Schemas["WordCard"][]} */ words) =>
  Object.fromEntries(words.map((card) => [card.word, card.means ?? QUESTION]));

/** The same choices with a row left out. @returns {Choices} */
export const without = (/** @type {Choices} */ choices, /** @type {Skipped} */ row) => ({
  ...choices,
  skipped: [...choices.skipped.filter((other) => other.line !== row.line), row].sort((a, b) => a.line - b.line),
});

/** The same choices with a row taken in again. @returns {Choices} */
export const withAgain = (/** @type {Choices} */ choices, /** @type {number} */ line) => ({
  ...choices,
  skipped: choices.skipped.filter((row) => row.line !== line),
});

/**
 * What a guess proposes; a unit that the file does not state is left open.
 * @param {Guess} guess
 * @returns {Choices}
 */
export function proposed(guess) {
  const choice = (/** @type {FieldGuess | QuantityGuess} */ guessed) => ({
    ...blank,
    column: guessed.column ?? null,
    unit: guessed.unit ?? "",
    formula: "formula" in guessed ? (guessed.formula ?? "") : "",
    words: "meanings" in guessed ? tableOf(guessed.meanings) : {},
  });
  const byName = (/** @type {(FieldGuess | QuantityGuess)[]} */ list) =>
    Object.fromEntries(list.map((guessed) => [guessed.name, choice(guessed)]));
  return {
    sheet: guess.sheet ?? null,
    titleLine: guess.title_line,
    unitLine: guess.unit_line ?? null,
    decimal: guess.decimal ?? null,
    skipped: [],
    fields: byName(guess.fields),
    quantities: byName(guess.quantities),
  };
}

/** A text of TOML in quotes. */
const quoted = (/** @type {string} */ text) => JSON.stringify(text).replaceAll("\x7f", "\\u007f");

/**
 * The text of the map. What is open is written as a question, which the service refuses at its field.
 * @param {Guess} guess
 * @param {Choices} choices
 */
export function mapOf(guess, choices) {
  const head = [];
  if (choices.sheet !== null) head.push(`sheet = ${quoted(choices.sheet)}`);
  head.push(`titles = ${choices.titleLine}`);
  if (choices.unitLine !== null) head.push(`units = ${choices.unitLine}`);
  if (choices.decimal !== null) head.push(`decimal = ${quoted(choices.decimal)}`);
  if (choices.skipped.length > 0) head.push(`skip = [${choices.skipped.map((row) => row.line).join(", ")}]`);
  const table = (
    /** @type {string} */ kind,
    /** @type {FieldGuess | QuantityGuess} */ field,
    /** @type {Choice} */ choice,
  ) => {
    const unit = field.units.length === 0 ? [] : [`unit = ${quoted(choice.unit || QUESTION)}`];
    const words = Object.entries(choice.words).map(([word, means]) => `${quoted(word)} = ${quoted(means)}`);
    if (choice.column !== null)
      return [
        `[${kind}.${field.name}]`,
        `column = ${quoted(choice.column)}`,
        ...unit,
        ...(choice.fillsDown ? ["fill_down = true"] : []),
        ...(words.length > 0 ? [`words = { ${words.join(", ")} }`] : []),
      ];
    if (choice.formula !== "") return [`[${kind}.${field.name}]`, `formula = ${quoted(choice.formula)}`];
    if (choice.value !== "") return [`[${kind}.${field.name}]`, `value = ${quoted(choice.value)}`, ...unit];
    return ("is_needed" in field && field.is_needed) || kind === "quantities"
      ? [`[${kind}.${field.name}]`, 'value = "?"', ...unit]
      : [];
  };
  const isUsed = Object.values(choices.fields).some((choice) => choice.formula !== "" && choice.column === null);
  const quantities = isUsed ? guess.quantities : [];
  const tables = [
    ...guess.fields.map((field) => table("columns", field, choices.fields[field.name])),
    ...quantities.map((field) => table("quantities", field, choices.quantities[field.name])),
  ].filter((lines) => lines.length > 0);
  return `${[head.join("\n"), ...tables.map((lines) => lines.join("\n"))].join("\n\n")}\n`;
}

/**
 * The complaints about a field, and those about none that is shown.
 * @param {Complaint[]} complaints
 * @param {string[]} names of the fields that are shown
 */
export function byField(complaints, names) {
  const ofField = (/** @type {string} */ name) => complaints.filter((complaint) => complaint.field === name);
  return { of: ofField, others: complaints.filter(({ field }) => !field || !names.includes(field)) };
}

/** A complaint in words: its place in the file, or nothing where its field says it. */
export function words(/** @type {Complaint} */ complaint) {
  const place = complaint.cell
    ? t`cell ${complaint.cell}`
    : complaint.line && complaint.file !== "map.toml"
      ? t`line ${complaint.line}`
      : "";
  const message = complaint.plain ?? complaint.message.replace(`${complaint.field}: `, "");
  return place === "" ? message : `${place}: ${message}`;
}
