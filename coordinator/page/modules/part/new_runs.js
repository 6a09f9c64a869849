// Measured runs are typed in here, the proposed ones first; the study is calibrated again with them.

import { d3 } from "../chart/library.js";
import { html, useState } from "../html.js";
import { addRuns } from "../rest/routes.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address } from "../route.js";
import { CHANNELS, short, shown, unitOf } from "../words/quantity.js";
import { table } from "../chart/download.js";
import { Failure } from "./message.js";

const COLUMNS = /** @type {Record<string, string>} */ ({ drawbar_pull: "drawbar_pull_n", torque: "torque_n_m", sinkage: "sinkage_m", lateral_force: "lateral_force_n" });

/** @param {{ study: any, record: any, comparison: any }} properties */
export function NewRuns({ study, record, comparison }) {
  const { answer: experiment } = useAnswer(path.experiment(study.experiment));
  const channels = CHANNELS.filter((c) => comparison.rows.some((/** @type {any} */ r) => r.channel === c));
  const proposed = record.next_runs.map((/** @type {any} */ r, /** @type {number} */ k) => ({
    run: `next-${comparison.rows.length}-${k + 1}`, slip: r.slip, load: r.wheel_load_n, speed: Number((1000 * r.sled_speed_m_s).toPrecision(4)), values: {} }));
  const [rows, setRows] = useState(/** @type {any[] | null} */ (null));
  const [failure, setFailure] = useState(/** @type {any} */ (null));
  const now = rows ?? proposed;
  const set = (/** @type {number} */ k, /** @type {any} */ change) => setRows(now.map((/** @type {any} */ row, /** @type {number} */ i) => (i === k ? { ...row, ...change } : row)));
  const first = firstRun(experiment);
  const isFilled = (/** @type {any} */ row) => channels.some((c) => (row.values[c] ?? "") !== "");
  const filled = now.filter(isFilled);
  const send = async (/** @type {Event} */ event) => {
    event.preventDefault();
    setFailure(null);
    const lines = filled.map((/** @type {any} */ row) => ({
      run: row.run, wheel: first?.wheel ?? comparison.rows[0].wheel, soil: first?.soil ?? "", slip: row.slip, wheel_load_n: row.load, sled_speed_m_s: Number(row.speed) / 1000,
      ...Object.fromEntries(channels.map((c) => [COLUMNS[c], (row.values[c] ?? "") === "" ? "" : Number((Number(row.values[c]) / shown(unitOf(c)).scale).toPrecision(9))])), use: "fit" }));
    try {
      const added = await addRuns(study.id, table(lines));
      location.hash = address(["studies", added.study, "live"]);
    } catch (error) {
      setFailure(error);
    }
  };
  const field = (/** @type {string} */ label, /** @type {any} */ value, /** @type {(text: string) => void} */ change) =>
    html`<td><input aria-label=${label} inputmode="decimal" size="7" value=${value} onInput=${(/** @type {any} */ e) => change(e.target.value)} /></td>`;
  return html`
    <h3>Add runs that you have made</h3>
    <form onSubmit=${send} class="new-runs">
      <div class="scroll" tabindex="0" role="region" aria-label="New runs"><table>
        <thead><tr><th scope="col">run</th><th scope="col">slip</th><th scope="col">load N</th><th scope="col">speed mm/s</th>${channels.map((c) => html`<th scope="col">${short(c)} ${shown(unitOf(c)).unit}</th>`)}</tr></thead>
        <tbody>${now.map((/** @type {any} */ row, /** @type {number} */ k) => html`<tr key=${k}>
          ${field(`name of run ${k + 1}`, row.run, (run) => set(k, { run }))}
          ${field(`slip of run ${k + 1}`, row.slip, (slip) => set(k, { slip }))}
          ${field(`wheel load of run ${k + 1} in N`, row.load, (load) => set(k, { load }))}
          ${field(`sled speed of run ${k + 1} in mm/s`, row.speed, (speed) => set(k, { speed }))}
          ${channels.map((c) => field(`${short(c)} of run ${k + 1} in ${shown(unitOf(c)).unit}`, row.values[c] ?? "", (text) => set(k, { values: { ...row.values, [c]: text } })))}
        </tr>`)}</tbody>
      </table></div>
      <div class="actions">
        <button type="button" onClick=${() => setRows([...now, { run: `next-${comparison.rows.length}-${now.length + 1}`, slip: "", load: "", speed: "", values: {} }])}>One more run</button>
        <button class="main" type="submit" disabled=${filled.length === 0}>${filled.length === 0 ? "Add runs: type what was measured" : `Add ${filled.length === 1 ? "1 run" : `${filled.length} runs`} and calibrate again`}</button>
      </div>
      <${Failure} error=${failure} />
    </form>`;
}

/** The first run of an experiment, whose wheel and soil further ones have. */
function firstRun(/** @type {any} */ experiment) {
  const files = Object.values(experiment?.files ?? {});
  const runs = files.find((text) => /^\uFEFF?run\s*,/m.test(/** @type {string} */ (text)));
  if (!runs) return null;
  // Row by row: a parser of objects compiles code, which the page's policy forbids. Comments may stand above the header.
  const rows = d3.csvParseRows(/** @type {string} */ (runs).replace(/^\uFEFF/, ""));
  const header = rows.find((row) => row[0] === "run") ?? [];
  const first = rows.slice(rows.indexOf(header) + 1).find((row) => row.length === header.length && !row[0].startsWith("#"));
  return first ? Object.fromEntries(header.map((column, k) => [column, first[k]])) : null;
}
