// A table of measurements in a person's own columns and units, turned into runs.csv.

/** @typedef {{ header: string[], rows: string[][] }} Sheet */
/** @typedef {{ column: number | null, value: string, unit: string }} Source column: of the sheet; null: the value, the same for all rows; blank: absent */
/** @typedef {{ name: string, title: string, isNeeded: boolean, units: Record<string, number>, value: string, pattern: RegExp }} Target */

const FORCE = { N: 1, kN: 1000 };
const LENGTH = { m: 1, mm: 0.001, cm: 0.01 };

/**
 * The columns of runs.csv: their units as factors to SI, the value where the sheet has no column, and the names that people give them.
 * @type {Target[]}
 */
export const TARGETS = [
  { name: "run", title: "run", isNeeded: true, units: {}, value: "", pattern: /^(run|test|id|name|versuch|nr)/i },
  { name: "wheel", title: "wheel", isNeeded: true, units: {}, value: "wheel", pattern: /^(wheel|rad)(_?name|_?id)?$/i },
  { name: "soil", title: "soil", isNeeded: true, units: {}, value: "soil", pattern: /^(soil|sand|boden)/i },
  { name: "slip", title: "slip", isNeeded: true, units: { ratio: 1, "%": 0.01 }, value: "", pattern: /^(slip(?!.*angle)|schlupf)/i },
  { name: "wheel_load_n", title: "wheel load", isNeeded: true, units: FORCE, value: "", pattern: /(load|fz|weight|last)/i },
  { name: "sled_speed_m_s", title: "sled speed", isNeeded: true, units: { "m/s": 1, "mm/s": 0.001, "cm/s": 0.01 }, value: "", pattern: /(speed|veloc|^v\b|geschw)/i },
  { name: "slip_angle_deg", title: "slip angle", isNeeded: false, units: { deg: 1, rad: 180 / Math.PI }, value: "", pattern: /(angle|beta|winkel)/i },
  { name: "drawbar_pull_n", title: "drawbar pull", isNeeded: false, units: FORCE, value: "", pattern: /(pull|drawbar|^dp\b|^fx|zug)/i },
  { name: "torque_n_m", title: "torque", isNeeded: false, units: { "N m": 1, "N cm": 0.01 }, value: "", pattern: /(torque|moment)/i },
  { name: "sinkage_m", title: "sinkage", isNeeded: false, units: LENGTH, value: "", pattern: /(sinkage|depth|einsink)/i },
  { name: "lateral_force_n", title: "lateral force", isNeeded: false, units: FORCE, value: "", pattern: /(lateral|^fy|seiten)/i },
  { name: "use", title: "use (fit or holdout)", isNeeded: false, units: {}, value: "", pattern: /^use$/i },
];

/** Lines of a file with its separator found out; `#` begins a comment, quotes may enclose a field of one line. */
export function parse(/** @type {string} */ text) {
  const lines = text.replace(/^\uFEFF/, "").split(/\r?\n/).filter((line) => line.trim() !== "" && !line.startsWith("#"));
  const count = (/** @type {string} */ mark) => (lines[0] ?? "").split(mark).length;
  const mark = [",", ";", "\t"].reduce((best, next) => (count(next) > count(best) ? next : best));
  const field = new RegExp(`("(?:[^"]|"")*"|[^${mark}]*)(?:${mark}|$)`, "g");
  const fields = lines.map((line) => [...`${line}${mark}`.matchAll(field)].slice(0, -1)
    .map(([, cell]) => (cell.startsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell).trim()));
  const [header = [], ...rows] = fields;
  return { header, rows };
}

/** Whether a header has the names of runs.csv. */
export const isRuns = (/** @type {string[]} */ header) => TARGETS.filter((t) => t.isNeeded).every((t) => header.includes(t.name));

/** A number with a point or a comma; null where it is none. */
export function number(/** @type {string} */ text) {
  const plain = text.trim().replace("−", "-").replace(/^([^.,]*),([^.,]*)$/, "$1.$2");
  return plain === "" || !Number.isFinite(Number(plain)) ? null : Number(plain);
}

/** The unit that the name of a column ends with, as `load [kN]` or `load_kn`; else the first of the target's. */
function unitIn(/** @type {string} */ title, /** @type {Target} */ target, /** @type {string[]} */ values) {
  const plain = (/** @type {string} */ text) => text.toLowerCase().replace(/[^a-z0-9%]+/g, "");
  const end = plain(title.replace(/^[^\s[(_]*/, ""));
  const known = Object.keys(target.units).sort((a, b) => b.length - a.length);
  const named = known.find((unit) => end.endsWith(plain(unit)) && (unit !== "m" || /[[(_ ]m[\])]?$/i.test(title)));
  if (named) return named;
  // A slip beyond 1 is a percentage.
  if (target.name === "slip" && values.some((value) => Math.abs(number(value) ?? 0) > 1)) return "%";
  return Object.keys(target.units)[0] ?? "";
}

/**
 * Where each column of runs.csv comes from, as far as the names of the sheet tell.
 * @param {Sheet} sheet
 * @returns {Record<string, Source>} by name of the target
 */
export function guess({ header, rows }) {
  /** @type {Set<number>} */
  const taken = new Set();
  return Object.fromEntries(TARGETS.map((target) => {
    const exact = header.indexOf(target.name);
    const found = exact >= 0 ? exact : header.findIndex((title, k) => !taken.has(k) && target.pattern.test(title.replace(/^(mean|avg|average)[_ ]/i, "")));
    if (found >= 0) taken.add(found);
    const unit = found < 0 ? Object.keys(target.units)[0] ?? "" : unitIn(header[found], target, rows.map((row) => row[found] ?? ""));
    return [target.name, { column: found < 0 ? null : found, value: found < 0 ? target.value : "", unit }];
  }));
}

/** Whether a column is absent. */
const isAbsent = (/** @type {Source} */ source) => source.column === null && source.value.trim() === "";

/**
 * What keeps a mapping from being used, in words; empty where nothing does.
 * @param {Sheet} sheet
 * @param {Record<string, Source>} sources
 */
export function problems(sheet, sources) {
  const missing = TARGETS.filter((t) => t.isNeeded && t.name !== "run" && isAbsent(sources[t.name]))
    .map((t) => `${t.title}: choose a column, or give the value that all rows have`);
  if (TARGETS.slice(7, 11).every((t) => isAbsent(sources[t.name]))) missing.push("no measured channel: choose the column of the drawbar pull, the torque, the sinkage or the lateral force");
  const bad = TARGETS.filter((t) => Object.keys(t.units).length > 0).flatMap((target) => {
    const { column, value } = sources[target.name];
    const cells = column === null ? [value] : sheet.rows.map((row) => row[column] ?? "");
    const wrong = cells.findIndex((cell) => cell.trim() !== "" && number(cell) === null);
    if (wrong < 0) return [];
    return [`${target.title}: "${cells[wrong]}"${column === null ? "" : ` in row ${wrong + 1}`} is not a number`];
  });
  return [...missing, ...bad];
}

/** A cell of runs.csv: text as it is, a number in SI to 9 digits. */
function cell(/** @type {string} */ text, /** @type {Target} */ target, /** @type {string} */ unit) {
  const value = Object.keys(target.units).length > 0 ? number(text) : null;
  if (value === null) return /[",]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  return String(Number((value * (target.units[unit] ?? 1)).toPrecision(9)));
}

/**
 * The cells of runs.csv, its header first.
 * @param {Sheet} sheet
 * @param {Record<string, Source>} sources
 */
export function convert(sheet, sources) {
  const targets = TARGETS.filter((t) => t.name === "run" || !isAbsent(sources[t.name]));
  const rows = sheet.rows.map((row, k) => targets.map((target) => {
    const { column, value, unit } = sources[target.name];
    if (target.name === "run" && column === null) return `r${k + 1}`;
    return cell(column === null ? value : row[column] ?? "", target, unit);
  }));
  return [targets.map((t) => t.name), ...rows];
}

/** The text of a file of cells. */
export const text = (/** @type {string[][]} */ cells) => `${cells.map((row) => row.join(",")).join("\n")}\n`;
