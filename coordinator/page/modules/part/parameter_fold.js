// What each parameter does: a folded part, whose modules and numbers are asked for when it is opened.

import { html, useState } from "../html.js";
import { Later } from "./later.js";

const sliders = () => import("./parameter_sliders.js").then((module) => module.ParameterSliders);

/**
 * @param {{ model: Member, line: LedgerEntry, rows: MeasuredRow[], axis: ConditionAxis, name: string }} properties
 *   line: of the ledger. rows: of the comparison. axis: the condition that the pictures are drawn against.
 */
export function ParameterFold({ model, line, rows, axis, name }) {
  const [isOpen, setOpen] = useState(false);
  if (!line) return null;
  const what =
    line.response_surface === null
      ? html`<p class="empty">The calibration has too few draws with outputs for a response surface.</p>`
      : html`
          <${Later}
            key=${model.id}
            title="What each parameter does"
            load=${sliders}
            model=${model}
            rows=${rows}
            axis=${axis}
            name=${name}
          />
        `;
  return html`
    <details class="sliders" onToggle=${(/** @type {DetailsEvent} */ event) => setOpen(event.currentTarget.open)}>
      <summary>What each parameter does</summary>
      ${isOpen && what}
    </details>
  `;
}
