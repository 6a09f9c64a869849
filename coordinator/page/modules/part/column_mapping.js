// Which column of a person's table is which column of runs.csv, and in which unit.

import { convert, guess, parse, problems, TARGETS, text } from "../columns.js";
import { html, useMemo, useState } from "../html.js";
import { Table } from "./table.js";

const PREVIEW = 5;
/** What the rows have where a column is absent. @type {Record<string, string>} */
const ABSENT = { run: "(numbered)", slip_angle_deg: "(0: straight ahead)", use: "(all rows are fitted)" };

/** @param {{ name: string, source: string, onRuns: (runs: string) => void }} properties source: the text of the table */
export function ColumnMapping({ name, source, onRuns }) {
  const sheet = useMemo(() => parse(source), [source]);
  const [sources, setSources] = useState(() => guess(sheet));
  const set = (/** @type {string} */ target, /** @type {object} */ change) => setSources({ ...sources, [target]: { ...sources[target], ...change } });
  const said = problems(sheet, sources);
  const [header, ...cells] = convert(sheet, sources);
  return html`
    <div class="card mapping">
      <h2>The columns of ${name}</h2>
      <p>Choose for each quantity the column of ${name} and its unit. Blank fields stay unmeasured.</p>
      <${Table} label=${`Columns of ${name}`} head=${["quantity", "column", "unit", "or the same in all rows"]}
        rows=${TARGETS.map((target) => row(target, sheet.header, sources[target.name], (change) => set(target.name, change)))} />
      <h3>The first rows as they will be read (SI units)</h3>
      <${Table} label="First rows of runs.csv" head=${header} rows=${cells.slice(0, PREVIEW)} numbers=${header.map((_, k) => k).filter((k) => k > 2 && header[k] !== "use")} />
      ${said.map((problem) => html`<p class="error">${problem}</p>`)}
      <button class="main" type="button" disabled=${said.length > 0} onClick=${() => onRuns(text([header, ...cells]))}>Use these columns</button>
    </div>`;
}

/** @returns {unknown[]} */
function row(/** @type {import("../columns.js").Target} */ target, /** @type {string[]} */ header, /** @type {import("../columns.js").Source} */ source, /** @type {(change: object) => void} */ onChange) {
  const units = Object.keys(target.units);
  const absent = ABSENT[target.name] ?? (target.isNeeded ? "(none)" : "(not measured)");
  return [
    target.title,
    html`<select aria-label=${`column of ${target.title}`} value=${source.column ?? ""} onChange=${(/** @type {any} */ e) => onChange({ column: e.target.value === "" ? null : Number(e.target.value) })}>
      <option value="" selected=${source.column === null}>${absent}</option>
      ${header.map((title, k) => html`<option value=${k} selected=${source.column === k}>${title}</option>`)}
    </select>`,
    units.length === 0 ? "" : html`<select aria-label=${`unit of ${target.title}`} value=${source.unit} onChange=${(/** @type {any} */ e) => onChange({ unit: e.target.value })}>
      ${units.map((unit) => html`<option value=${unit} selected=${source.unit === unit}>${unit}</option>`)}
    </select>`,
    source.column !== null || target.name === "run" ? "" : html`<input size="10" aria-label=${`${target.title} of all rows`} value=${source.value} onInput=${(/** @type {any} */ e) => onChange({ value: e.target.value })} />`,
  ];
}
