// The table of runs: measured, computed, interval, residual.

import { html, useEffect, useState } from "../html.js";
import { t } from "../language/language.js";
import { slipWords } from "../words/condition.js";
import { digits, minus, shown, short, titled } from "../words/quantity.js";
import { light, point, toggle } from "../selection.js";

/** Number of rows on a page of the table; more cells take long to create. */
const PAGE_ROWS = 120;

/** @param {{ rows: MeasuredRow[] }} properties rows of a comparison */
export function RunTable({ rows }) {
  const [first, setFirst] = useState(0);
  const last = Math.min(first + PAGE_ROWS, rows.length);
  const go = (/** @type {number} */ to) => () => setFirst(to);
  // The rows of a new page are marked where their runs are chosen.
  useEffect(() => light(document), [first]);
  return html`
    ${
      rows.length > PAGE_ROWS &&
      html`
        <div class="actions" role="group" aria-label="Rows of the table">
          <button type="button" disabled=${first === 0} onClick=${go(first - PAGE_ROWS)}>Rows before</button>
          <button type="button" disabled=${last === rows.length} onClick=${go(first + PAGE_ROWS)}>Rows after</button>
          <span class="note" role="status">${t`rows ${first + 1} to ${last} of ${rows.length}`}</span>
        </div>
      `
    }
    <div class="scroll" tabindex="0" role="region" aria-label="All runs">
      <table>
        <thead>
          <tr>
            ${[
              t`run`,
              t`use`,
              t`slip`,
              titled(t`load`, shown("N").unit),
              titled(t`speed`, shown("m/s").unit),
              t`channel`,
              t`measured`,
              t`model`,
              t`90 % interval`,
              t`residual, noise sds`,
            ].map((h, k) => html`<th scope="col" class=${k > 1 && k !== 5 ? "number" : ""}>${h}</th>`)}
          </tr>
        </thead>
        <tbody>
          ${rows.slice(first, last).map((r) => html`<${RunRow} key=${`${r.run} ${r.channel}`} row=${r} />`)}
        </tbody>
      </table>
    </div>
  `;
}

/** The share of the final draws at which the model refuses a run, in front of what the others predict. */
function refusal(/** @type {MeasuredRow} */ row) {
  return row.refused ? `refused at ${digits((100 * row.refused.draws) / row.refused.of, 2)} % ` : "";
}

function RunRow(/** @type {{ row: MeasuredRow }} */ { row }) {
  const quantity = shown(row.unit);
  const value = (/** @type {number | null | undefined} */ v) =>
    digits(typeof v === "number" ? v * quantity.scale : null);
  return html`
    <tr data-run=${row.run} onMouseEnter=${() => point([row.run])} onMouseLeave=${() => point(null)}>
      <th scope="row"><button class="plain" type="button" onClick=${() => toggle(row.run)}>${row.run}</button></th>
      <td>${row.use === "holdout" ? t`held out` : t`fit`}</td>
      <td class="number">${slipWords(row.slip)}</td>
      <td class="number">${digits(row.wheel_load_n * shown("N").scale)}</td>
      <td class="number">${digits(row.sled_speed_m_s * shown("m/s").scale)}</td>
      <td>${short(row.channel)} ${quantity.unit}</td>
      <td class="number">${value(row.measured)}</td>
      <td
        class="number"
        title=${
          row.refused
            ? `refused at ${row.refused.draws} of ${row.refused.of} final draws: ${row.refused.reason}`
            : undefined
        }
      >
        ${refusal(row)}
        ${row.refused && typeof row.predicted !== "number" ? "" : value(row.predicted)}
      </td>
      <td class="number">${typeof row.q05 !== "number" ? "–" : t`${value(row.q05)} to ${value(row.q95)}`}</td>
      <td class="number">${typeof row.residual_sigma !== "number" ? "–" : minus(row.residual_sigma.toFixed(1))}</td>
    </tr>
  `;
}
