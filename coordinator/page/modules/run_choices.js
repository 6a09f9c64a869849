// Which runs of runs.csv are fitted, held out or excluded, and why. An excluded run stays in the file as a comment,
// with its reason.

/** @typedef {{ run: string, use: "fit" | "holdout" | "excluded", reason: string, cells: string[] }} ChosenRun */

const EXCLUDED = /^# excluded: (.*?); run: (.*)$/;
const HELD_OUT = /^# held out: (.*?); run: (.*)$/;

/** The fields of a line: commas part them, quotes may enclose them. */
function fields(/** @type {string} */ line) {
  const found = [...`${line},`.matchAll(/("(?:[^"]|"")*"|[^,]*),/g)].map(([, cell]) => cell);
  return found.map((cell) => (cell.startsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell).trim());
}

const written = (/** @type {string[]} */ cells) =>
  cells.map((cell) => (/[",]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell)).join(",");

/** A reason in one line, without what ends it. */
const tidy = (/** @type {string} */ reason) =>
  reason
    .replace(/[\r\n]+/g, " ")
    .replaceAll("; run:", ", run:")
    .trim();

/**
 * The runs of a runs.csv.
 * @param {string} text
 * @returns {{ head: string[], header: string[], runs: ChosenRun[] }} head: other comments above
 */
export function read(text) {
  const lines = text
    .replace(/^\uFEFF/, "")
    .split(/\r?\n/)
    .filter((line) => line.trim() !== "");
  const header = fields(lines.find((line) => !line.startsWith("#")) ?? "");
  const [name, use] = [header.indexOf("run"), header.indexOf("use")];
  /** @type {Map<string, string>} */
  const reasons = new Map();
  /** @type {string[]} */
  const head = [];
  /** @type {ChosenRun[]} */
  const runs = [];
  let isBelow = false;
  for (const line of lines) {
    const [, excludedFor, row] = EXCLUDED.exec(line) ?? [];
    const [, heldOutFor, held] = HELD_OUT.exec(line) ?? [];
    if (row !== undefined)
      runs.push({ run: fields(row)[name] ?? "", use: "excluded", reason: excludedFor, cells: fields(row) });
    else if (held !== undefined) reasons.set(held, heldOutFor);
    else if (line.startsWith("#")) head.push(line);
    else if (!isBelow) isBelow = true;
    else {
      const cells = fields(line);
      runs.push({
        run: cells[name] ?? "",
        use: use >= 0 && cells[use] === "holdout" ? "holdout" : "fit",
        reason: "",
        cells,
      });
    }
  }
  return {
    head,
    header,
    runs: runs.map((run) => (run.use === "holdout" ? { ...run, reason: reasons.get(run.run) ?? "" } : run)),
  };
}

/** The text of a runs.csv with its runs as chosen. @param {ReturnType<typeof read>} file */
export function write({ head, header, runs }) {
  const place = header.indexOf("use");
  const isUsed = place >= 0 || runs.some((run) => run.use === "holdout");
  const columns = isUsed && place < 0 ? [...header, "use"] : header;
  const at = place < 0 ? columns.length - 1 : place;
  const row = (/** @type {ChosenRun} */ { use, cells }) =>
    written(columns.map((_, k) => (isUsed && k === at ? (use === "holdout" ? "holdout" : "fit") : (cells[k] ?? ""))));
  const lines = runs.flatMap((run) => {
    if (run.use === "excluded") return [`# excluded: ${tidy(run.reason)}; run: ${row(run)}`];
    const reason =
      run.use === "holdout" && run.reason !== "" ? [`# held out: ${tidy(run.reason)}; run: ${run.run}`] : [];
    return [...reason, row(run)];
  });
  return `${[...head, written(columns), ...lines].join("\n")}\n`;
}
