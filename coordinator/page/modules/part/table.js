// A table that scrolls by itself where the screen is narrow, and that a keyboard reaches.

import { html } from "../html.js";

/**
 * @param {{ label: string, head: unknown[], rows: unknown[][], numbers?: number[], labels?: unknown[] }} properties
 *   numbers: the columns that are aligned at the right. The first cell of a row heads it.
 *   labels: the words of the head, where it is none.
 */
export function Table({ label, head, rows, numbers = [], labels = head }) {
  const kind = (/** @type {number} */ k) => (numbers.includes(k) ? "number" : "");
  return html`
    <div class="scroll stacked" tabindex="0" role="region" aria-label=${label}>
      <table>
        <thead>
          <tr>
            ${head.map((cell, k) =>
              cell === "" ? html`<td></td>` : html`<th scope="col" class=${kind(k)}>${cell}</th>`,
            )}
          </tr>
        </thead>
        <tbody>
          ${rows.map(
            (row) =>
              html`
                <tr>
                  ${row.map((cell, k) =>
                    k === 0
                      ? html`<th scope="row" class=${kind(k)}>${cell}</th>`
                      : html`<td class=${kind(k)} data-label=${labels[k]}>${cell}</td>`,
                  )}
                </tr>
              `,
          )}
        </tbody>
      </table>
    </div>
  `;
}
