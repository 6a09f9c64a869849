// The error ledger as a picture: how the error falls from the base to each extension, and the models as layers over the
// data.

import { html, useState } from "../html.js";
import { colour } from "../chart/colour.js";
import { varying } from "../chart/condition.js";
import { AxisPicker, ChannelCharts } from "../part/channel_charts.js";
import { Ledger } from "../part/ledger.js";
import { NoModel } from "../part/no_model.js";
import { LedgerCharts } from "../chart/ledger_chart.js";
import { ledgerLines } from "../chart/ledger_lines.js";
import { path } from "../rest/routes.js";
import { useAnswers } from "../rest/use_answer.js";

/** @param {{ study: Study }} properties */
export function Errors({ study }) {
  const [hidden, setHidden] = useState(/** @type {number[]} */ ([]));
  const [key, setKey] = useState("slip");
  const lines = ledgerLines(study);
  // Models that the job compares are layers, too; the ledger has the chosen one and what it grew into.
  const compared = (study.models?.models ?? []).filter((m) => !lines.some((line) => line.id === m.calibration));
  const all = [
    ...lines,
    ...compared.map((m, k) => ({
      id: m.calibration,
      name: m.name,
      colour: colour(lines.length + k),
    })),
  ];
  const shown = all.filter((line) => !hidden.includes(line.id));
  const answers = useAnswers(shown.map((line) => path.comparison(line.id)));
  if (lines.length === 0 && ["failed", "cancelled"].includes(study.state)) return html`<${NoModel} study=${study} />`;
  if (lines.length === 0)
    return html`
      <p class="empty">The ledger has a line for each finished calibration with a posterior; none is finished yet.</p>
    `;
  const flip = (/** @type {number} */ id) =>
    setHidden(hidden.includes(id) ? hidden.filter((h) => h !== id) : [...hidden, id]);
  const layers = shown
    .filter((line) => path.comparison(line.id) in answers)
    .map((line) => ({ name: line.name, colour: line.colour, rows: answers[path.comparison(line.id)].rows }));
  const axes = layers.length > 0 ? varying(layers[0].rows) : [];
  const axis = axes.find((a) => a.key === key) ?? axes[0];
  return html`
    <p class="note">Root mean square errors in the unit of each channel. Held-out runs are never fitted.</p>
    ${lines.length > 1 && html`<${LedgerCharts} study=${study} lines=${lines} />`}
    <${Ledger} study=${study} lines=${lines} />
    <h2>The models over the data</h2>
    <div class="actions" role="group" aria-label="Models that are shown">
      ${all.map(
        (line) => html`
          <button type="button" aria-pressed=${!hidden.includes(line.id)} onClick=${() => flip(line.id)}>
            <i class="swatch" style=${{ background: line.colour }}></i> ${line.name}
          </button>
        `,
      )}
    </div>
    ${
      axis &&
      html`
        <${AxisPicker} axes=${axes} axis=${axis} choose=${setKey} />
        <${ChannelCharts} layers=${layers} axis=${axis} name=${`${study.name}-layers`} />
      `
    }
  `;
}
