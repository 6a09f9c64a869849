// The map of an import as a person clicks it together: its text, and which field a complaint belongs to.

/** @typedef {{ column: string | null, value: string, unit: string, formula: string }} Choice blank: absent */
/** @typedef {{ sheet: string | null, titleLine: number, unitLine: number | null, decimal: string | null, fields: Record<string, Choice>, quantities: Record<string, Choice> }} Choices */

const blank = { column: null, value: "", unit: "", formula: "" };

/**
 * What a guess proposes; a unit that the file does not state is left open.
 * @param {any} guess
 * @returns {Choices}
 */
export function proposed(guess) {
  const choice = (/** @type {any} */ of) => ({ ...blank, column: of.column ?? null, unit: of.unit ?? "", formula: of.formula ?? "" });
  const byName = (/** @type {any[]} */ list) => Object.fromEntries(list.map((one) => [one.name, choice(one)]));
  return { sheet: guess.sheet ?? null, titleLine: guess.title_line, unitLine: guess.unit_line ?? null, decimal: guess.decimal ?? null,
    fields: byName(guess.fields), quantities: byName(guess.quantities) };
}

/** A text of TOML in quotes. */
const quoted = (/** @type {string} */ text) => JSON.stringify(text).replaceAll("\x7f", "\\u007f");

/**
 * The text of the map. What is open is written as a question, which the service refuses at its field.
 * @param {any} guess
 * @param {Choices} choices
 */
export function mapOf(guess, choices) {
  const head = [];
  if (choices.sheet !== null) head.push(`sheet = ${quoted(choices.sheet)}`);
  head.push(`titles = ${choices.titleLine}`);
  if (choices.unitLine !== null) head.push(`units = ${choices.unitLine}`);
  if (choices.decimal !== null) head.push(`decimal = ${quoted(choices.decimal)}`);
  const table = (/** @type {string} */ kind, /** @type {any} */ of, /** @type {Choice} */ choice) => {
    const unit = of.units.length === 0 ? [] : [`unit = ${quoted(choice.unit || "?")}`];
    if (choice.column !== null) return [`[${kind}.${of.name}]`, `column = ${quoted(choice.column)}`, ...unit];
    if (choice.formula !== "") return [`[${kind}.${of.name}]`, `formula = ${quoted(choice.formula)}`];
    if (choice.value !== "") return [`[${kind}.${of.name}]`, `value = ${quoted(choice.value)}`, ...unit];
    return of.is_needed || kind === "quantities" ? [`[${kind}.${of.name}]`, 'value = "?"', ...unit] : [];
  };
  const isUsed = Object.values(choices.fields).some((choice) => choice.formula !== "" && choice.column === null);
  const quantities = isUsed ? guess.quantities : [];
  const tables = [
    ...guess.fields.map((/** @type {any} */ of) => table("columns", of, choices.fields[of.name])),
    ...quantities.map((/** @type {any} */ of) => table("quantities", of, choices.quantities[of.name])),
  ].filter((lines) => lines.length > 0);
  return `${[head.join("\n"), ...tables.map((lines) => lines.join("\n"))].join("\n\n")}\n`;
}

/**
 * The complaints about a field, and those about none that is shown.
 * @param {any[]} complaints
 * @param {string[]} names of the fields that are shown
 */
export function byField(complaints, names) {
  const of = (/** @type {string} */ name) => complaints.filter((complaint) => complaint.field === name);
  return { of, others: complaints.filter((complaint) => !names.includes(complaint.field)) };
}

/** A complaint in words: its place in the file, or nothing where its field says it. */
export function words(/** @type {any} */ complaint) {
  const place = complaint.cell ? `cell ${complaint.cell}` : complaint.line && complaint.file !== "map.toml" ? `line ${complaint.line}` : "";
  const message = complaint.message.replace(`${complaint.field}: `, "");
  return place === "" ? message : `${place}: ${message}`;
}
