// Measured runs are typed in here, the proposed ones first; the study is calibrated again with them, or a campaign goes
// on with them.

import { errorOf } from "../rest/answers.js";
import { d3 } from "../chart/library.js";
import { table } from "../chart/download.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { addRuns, path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address } from "../route.js";
import { slipUnit } from "../units.js";
import { CHANNELS, numberOf, short, shown, titled, unitOf } from "../words/quantity.js";
import { Failure } from "./message.js";

/** A value in SI as a person would type it. */
const typed = (/** @type {number} */ value, /** @type {{ scale: number }} */ { scale }) =>
  String(Number((value * scale).toPrecision(4)));

const COLUMNS = /** @type {Record<string, string>} */ ({
  drawbar_pull: "drawbar_pull_n",
  torque: "torque_n_m",
  sinkage: "sinkage_m",
  lateral_force: "lateral_force_n",
});

/**
 * @typedef {{ run: string, rig: string, slip: string, load: string, speed: string, angle: string, values:
 *   Record<string, string> }} NewRun
 */

/**
 * @param {{ study: Study, model: Member, record: { next_runs: NextRun[] }, comparison: Comparison, reload?: () => void,
 *   follow?: (rows: import("../chart/figure.js").Row[]) => Promise<void>, further?: number }} properties follow: takes
 *   the rows in place of a calibration. further: the number of runs that the study does not have and whose names are
 *   taken
 */
export function NewRuns({ study, model, record, comparison, reload, follow, further = 0 }) {
  const { answer: experiment, error } = useAnswer(path.experiment(study.experiment));
  const [rows, setRows] = useState(/** @type {NewRun[] | null} */ (null));
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isBusy, setBusy] = useState(false);
  const channels = CHANNELS.filter((c) => comparison.rows.some((r) => r.channel === c));
  const rigs = rigsOf(experiment);
  const isAngled = new Set(comparison.rows.map((r) => r.slip_angle_deg)).size > 1;
  const count = new Set(comparison.rows.map((r) => r.run)).size + further;
  const blank = (/** @type {number} */ k) => ({
    run: `next-${count + k + 1}`,
    rig: "",
    slip: "",
    load: "",
    speed: "",
    angle: "",
    values: {},
  });
  // Runs are proposed for the wheel of the first fitted run, straight ahead.
  const first = comparison.rows.find((r) => r.use === "fit");
  const proposed = record.next_runs.map((r, k) => ({
    ...blank(k),
    rig: rigs.find((rig) => rig.wheel === first?.wheel)?.label ?? "",
    angle: isAngled ? "0" : "",
    slip: typed(r.slip, slipUnit),
    load: typed(r.wheel_load_n, shown("N")),
    speed: typed(r.sled_speed_m_s, shown("m/s")),
  }));
  const now = rows ?? (proposed.length > 0 ? proposed : [blank(0)]);
  const set = (/** @type {number} */ k, /** @type {Partial<NewRun>} */ change) =>
    setRows(now.map((/** @type {NewRun} */ row, /** @type {number} */ i) => (i === k ? { ...row, ...change } : row)));
  const isFilled = (/** @type {NewRun} */ row) => channels.some((c) => (row.values[c] ?? "") !== "");
  const filled = now.filter(isFilled);
  const unit = (/** @type {string} */ c) => shown(unitOf(c));
  const lineOf = (/** @type {NewRun} */ row) => {
    const value = (/** @type {string} */ what, /** @type {string} */ text, scale = 1) => {
      const number = numberOf(text);
      if (number === null) throw new Error(t`${what} of run ${row.run}: “${text}” is no number`);
      return Number((number / scale).toPrecision(9));
    };
    const rig = rigs.length === 1 ? rigs[0] : rigs.find((r) => r.label === row.rig);
    if (!rig) throw new Error(t`run ${row.run}: choose its wheel`);
    return {
      run: row.run,
      wheel: rig.wheel,
      soil: rig.soil,
      slip: value(t`slip`, row.slip, slipUnit.scale),
      wheel_load_n: value(t`wheel load`, row.load, shown("N").scale),
      sled_speed_m_s: value(t`sled speed`, row.speed, shown("m/s").scale),
      ...(isAngled ? { slip_angle_deg: value(t`slip angle`, row.angle) } : {}),
      ...Object.fromEntries(
        channels.map((c) => [
          COLUMNS[c],
          (row.values[c] ?? "") === "" ? "" : value(short(c), row.values[c], unit(c).scale),
        ]),
      ),
      use: "fit",
    };
  };
  const send = async (/** @type {Event} */ event) => {
    event.preventDefault();
    setFailure(null);
    setBusy(true);
    try {
      const lines = filled.map(lineOf);
      if (follow) await follow(lines);
      else {
        // To the model that is shown: the runs that its search proposes tell its explanations apart.
        const added = await addRuns(study.id, table(lines), model.id);
        reload?.();
        location.hash = address(["studies", added.study, "live"]);
      }
    } catch (error) {
      setFailure(errorOf(error));
    }
    setBusy(false);
  };
  const field = (
    /** @type {string} */ label,
    /** @type {string} */ value,
    /** @type {(text: string) => void} */ change,
    isNumber = true,
  ) =>
    html`
      <td data-label=${label}>
        <input
          aria-label=${label}
          inputmode=${isNumber ? "decimal" : "text"}
          aria-invalid=${isNumber && value !== "" && numberOf(value) === null}
          size="7"
          value=${value}
          onInput=${(/** @type {FieldEvent} */ e) => change(e.currentTarget.value)}
        />
      </td>
    `;
  return html`
    <h3>${follow ? t`The next run that you have made` : t`Add runs that you have made`}</h3>
    <form onSubmit=${send} class="new-runs">
      <div class="scroll stacked" tabindex="0" role="region" aria-label="New runs">
        <table>
          <thead>
            <tr>
              <th scope="col">run</th>
              ${rigs.length > 1 && html`<th scope="col">wheel</th>`}
              <th scope="col">${titled(t`slip`, slipUnit.unit)}</th>
              <th scope="col">${titled(t`load`, shown("N").unit)}</th>
              <th scope="col">${titled(t`sled speed`, shown("m/s").unit)}</th>
              ${isAngled && html`<th scope="col">${titled(t`slip angle`, "°")}</th>`}
              ${channels.map((c) => html`<th scope="col">${titled(short(c), unit(c).unit)}</th>`)}
            </tr>
          </thead>
          <tbody>
            ${now.map(
              (/** @type {NewRun} */ row, /** @type {number} */ k) => html`
                <tr key=${k}>
                  ${field(t`name of run ${k + 1}`, row.run, (run) => set(k, { run }), false)}
                  ${
                    rigs.length > 1 &&
                    html`
                      <td data-label=${t`wheel of run ${k + 1}`}>
                        <select
                          aria-label=${t`wheel of run ${k + 1}`}
                          value=${row.rig}
                          required=${isFilled(row)}
                          onChange=${(/** @type {SelectEvent} */ e) => set(k, { rig: e.currentTarget.value })}
                        >
                          <option value="">choose</option>
                          ${rigs.map(
                            (rig) =>
                              html`<option value=${rig.label} selected=${rig.label === row.rig}>${rig.label}</option>`,
                          )}
                        </select>
                      </td>
                    `
                  }
                  ${field(t`slip of run ${k + 1}`, row.slip, (slip) => set(k, { slip }))}
                  ${field(t`wheel load of run ${k + 1} in ${shown("N").unit}`, row.load, (load) => set(k, { load }))}
                  ${field(t`sled speed of run ${k + 1} in ${shown("m/s").unit}`, row.speed, (speed) =>
                    set(k, { speed }),
                  )}
                  ${
                    isAngled && field(t`slip angle of run ${k + 1} in degrees`, row.angle, (angle) => set(k, { angle }))
                  }
                  ${channels.map((c) =>
                    field(t`${short(c)} of run ${k + 1} in ${unit(c).unit}`, row.values[c] ?? "", (text) =>
                      set(k, { values: { ...row.values, [c]: text } }),
                    ),
                  )}
                </tr>
              `,
            )}
          </tbody>
        </table>
      </div>
      <div class="actions">
        <button type="button" onClick=${() => setRows([...now, blank(now.length)])}>One more run</button>
        <button class="main" type="submit" disabled=${filled.length === 0 || isBusy || rigs.length === 0}>
          ${
            isBusy
              ? t`is being computed …`
              : filled.length === 0
                ? t`Add runs: type what was measured`
                : follow
                  ? t`Follow with ${filled.length} more`
                  : filled.length === 1
                    ? t`Add 1 run and calibrate again`
                    : t`Add ${filled.length} runs and calibrate again`
          }
        </button>
      </div>
      <${Failure} error=${failure ?? error} />
    </form>
  `;
}

/**
 * The wheels of an experiment with the soils that they ran on.
 * @returns {{ wheel: string, soil: string, label: string }[]}
 */
function rigsOf(/** @type {Answer<"get_experiment"> | null} */ experiment) {
  // Row by row: a parser of objects compiles code, which the page's policy forbids. Comments may stand above the
  // header.
  const tables = Object.values(experiment?.files ?? {}).map((text) =>
    d3.csvParseRows(text.replace(/^\uFEFF/, "")).map((row) => row.map((cell) => cell.trim())),
  );
  const headerOf = (/** @type {string[][]} */ rows) => rows.find((row) => row.includes("run") && row.includes("wheel"));
  const rows = tables.find(headerOf) ?? [];
  const header = headerOf(rows) ?? [];
  const own = rows
    .slice(rows.indexOf(header) + 1)
    .filter((row) => row.length === header.length && !row[0].startsWith("#"));
  const [wheel, soil] = [header.indexOf("wheel"), header.indexOf("soil")];
  const pairs = new Map(
    own.map((row) => [`${row[wheel]} ${row[soil] ?? ""}`, { wheel: row[wheel], soil: row[soil] ?? "" }]),
  );
  const isOneSoil = new Set([...pairs.values()].map((pair) => pair.soil)).size === 1;
  return [...pairs.values()].map((pair) => ({
    ...pair,
    label: isOneSoil ? pair.wheel : t`${pair.wheel} on ${pair.soil}`,
  }));
}
