// What a search is doing, and which explanations lead so far.

import { html } from "../html.js";
import { translated, t } from "../language/language.js";
import { probability } from "../words/quantity.js";

/** @param {{ search: Schemas["SearchProgress"] }} properties search: of the progress of a search */
export function Leaders({ search }) {
  return html`
    <p>The search now ${translated(search.doing)}.</p>
    ${
      search.leaders.length > 0 &&
      html`
        <h3>Leaders so far</h3>
        <ol class="leaders bars" aria-label="Leaders so far">
          ${search.leaders.map(
            (leader) => html`
              <li key=${leader.effects.join(" ")}>
                <span class="bar"><i style=${{ width: `${(100 * leader.probability).toFixed(1)}%` }}></i></span>
                <span class="number">P ${probability(leader.probability)}</span>
                <span>${leader.effects.length === 0 ? t`nothing is missing` : leader.effects.join(" + ")}</span>
              </li>
            `,
          )}
        </ol>
        <p class="note">Among what is fitted so far; the end weighs classes and laws as well.</p>
      `
    }
  `;
}
