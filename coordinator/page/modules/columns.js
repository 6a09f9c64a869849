// Tables of text as they are dropped: their fields, and whether they are runs.csv already.

/** @typedef {{ header: string[], rows: string[][] }} Sheet */

/** The columns that runs.csv must have. */
const NEEDED = ["run", "wheel", "soil", "slip", "wheel_load_n", "sled_speed_m_s"];

/** Lines of a file with its separator found out; `#` begins a comment, quotes may enclose a field of one line. */
export function parse(/** @type {string} */ text) {
  const lines = text
    .replace(/^\uFEFF/, "")
    .split(/\r?\n/)
    .filter((line) => line.trim() !== "" && !line.startsWith("#"));
  const count = (/** @type {string} */ mark) => (lines[0] ?? "").split(mark).length;
  const mark = [",", ";", "\t"].reduce((best, next) => (count(next) > count(best) ? next : best));
  const field = new RegExp(`("(?:[^"]|"")*"|[^${mark}]*)(?:${mark}|$)`, "g");
  const fields = lines.map((line) =>
    [...`${line}${mark}`.matchAll(field)]
      .slice(0, -1)
      .map(([, cell]) => (cell.startsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell).trim()),
  );
  const [header = [], ...rows] = fields;
  return { header, rows };
}

/** Whether a header has the names of runs.csv. */
export const isRuns = (/** @type {string[]} */ header) => NEEDED.every((name) => header.includes(name));
