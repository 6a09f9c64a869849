// The runs of a draft as a table: each is fitted, held out or excluded, with a reason.

import { html, useMemo, useState } from "../html.js";
import { t } from "../language/language.js";
import { read, write } from "../run_choices.js";
import { slipUnit } from "../units.js";
import { digits, numberOf, shown, titled } from "../words/quantity.js";
import { Table } from "./table.js";

const USES = /** @type {[import("../run_choices.js").ChosenRun["use"], string][]} */ ([
  ["fit", t`fitted`],
  ["holdout", t`held out: never fitted`],
  ["excluded", t`excluded`],
]);
/** What is shown of a run: its column, name and unit. @type {[string, string, { unit: string, scale: number }][]} */
const SHOWN = [
  ["slip", t`slip`, slipUnit],
  ["wheel_load_n", t`load`, shown("N")],
  ["sled_speed_m_s", t`speed`, shown("m/s")],
  ["drawbar_pull_n", t`pull`, shown("N")],
  ["torque_n_m", t`torque`, shown("N m")],
  ["sinkage_m", t`sinkage`, shown("m")],
];

/** @param {{ text: string, onText: (text: string) => void }} properties text: of runs.csv */
export function RunChoices({ text, onText }) {
  const [isOpen, setOpen] = useState(false);
  const file = useMemo(() => read(text), [text]);
  const columns = SHOWN.filter(([name]) => file.header.includes(name));
  const cell = (/** @type {string} */ text, /** @type {number} */ scale) =>
    numberOf(text) === null ? text : digits(/** @type {number} */ (numberOf(text)) * scale);
  const change = (/** @type {number} */ k, /** @type {Partial<(typeof file.runs)[number]>} */ to) =>
    onText(write({ ...file, runs: file.runs.map((run, i) => (i === k ? { ...run, ...to } : run)) }));
  const count = (/** @type {string} */ use) => file.runs.filter((run) => run.use === use).length;
  const everyFourth = () =>
    onText(
      write({
        ...file,
        runs: file.runs.map((run, k) =>
          run.use === "excluded" ? run : { ...run, use: k % 4 === 3 ? "holdout" : "fit" },
        ),
      }),
    );
  const rows = isOpen
    ? file.runs.map((run, k) => [
        run.run,
        html`
          <select
            aria-label=${t`use of run ${run.run}`}
            value=${run.use}
            onChange=${(/** @type {SelectEvent} */ e) =>
              change(k, { use: USES.find(([use]) => use === e.currentTarget.value)?.[0] ?? run.use })}
          >
            ${USES.map(([value, name]) => html`<option value=${value} selected=${value === run.use}>${name}</option>`)}
          </select>
        `,
        run.use === "fit"
          ? ""
          : html`
              <input
                aria-label=${t`reason of run ${run.run}`}
                placeholder="reason"
                value=${run.reason}
                onChange=${(/** @type {FieldEvent} */ e) => change(k, { reason: e.currentTarget.value })}
              />
            `,
        ...columns.map(([name, , { scale }]) => cell(run.cells[file.header.indexOf(name)] ?? "", scale)),
      ])
    : [];
  return html`
    <details class="card" onToggle=${(/** @type {DetailsEvent} */ event) => setOpen(event.currentTarget.open)}>
      <summary>Runs: ${count("fit")} fitted, ${count("holdout")} held out, ${count("excluded")} excluded</summary>
      <p class="note">
        Held-out runs are never fitted: they show how well the model predicts. An excluded run stays in the file as a
        comment with its reason.
      </p>
      <p class="actions"><button type="button" onClick=${everyFourth}>Hold out every fourth run</button></p>
      ${
        isOpen &&
        html`
          <${Table}
            label="Runs of the draft"
            head=${[t`run`, t`use`, t`reason`, ...columns.map(([, words, { unit }]) => titled(words, unit))]}
            rows=${rows}
            numbers=${columns.map((_, k) => k + 3)}
          />
        `
      }
    </details>
  `;
}
