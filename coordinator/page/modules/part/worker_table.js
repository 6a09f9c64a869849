// The workers as a table: what they have done, and when they were heard of.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { ago } from "../words/state.js";
import { Table } from "./table.js";

/** @param {{ workers: Record<string, FarmWorker> }} properties by name */
export function WorkerTable({ workers }) {
  const rows = Object.entries(workers).map(([name, worker]) => [
    name,
    worker.quarantined
      ? html`<span class="state failed">left out: ${worker.quarantined}</span>`
      : worker.holds > 0
        ? t`computes ${worker.holds} evaluations`
        : t`waits for work`,
    worker.completed,
    worker.faults,
    ago(worker.silent_ms),
    worker.model_version,
  ]);
  return html`
    <${Table}
      label="Workers"
      numbers=${[2, 3]}
      rows=${rows}
      head=${[t`worker`, t`state`, t`evaluations done`, t`faults`, t`heard of`, t`version of the equations`]}
    />
  `;
}
