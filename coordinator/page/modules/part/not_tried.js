// What the search cannot speak about: what the experiment does not state, what is too weak to see, what the model
// refuses.

import { html } from "../html.js";
import { t, translated } from "../language/language.js";
import { said } from "../words/clauses.js";

/** Names without `EFFECT.WHEEL` where `EFFECT` is in the list. */
function folded(/** @type {string[]} */ names) {
  return names.filter((name) => !name.includes(".") || !names.includes(name.split(".")[0]));
}

/** @typedef {{ names: string[], why: string, needs: string }} Reason */

/** Effects that are not tried, those of one reason together. */
function byReason(/** @type {NonNullable<Discovery["not_tried"]>} */ untried) {
  /** @type {Map<string, Reason>} */
  const reasons = new Map();
  for (const { name, why, needs } of untried) {
    const reason = reasons.get(`${why} ${needs}`) ?? { names: [], why, needs };
    reason.names.push(name);
    reasons.set(`${why} ${needs}`, reason);
  }
  return [...reasons.values()];
}

/** @param {{ record: Discovery }} properties */
export function NotTried({ record }) {
  // What needs a value that the experiment lacks is weighed with a typical one, has its row above, and is never named.
  const weighed = new Set(record.effects.map((effect) => effect.name));
  const untried = record.not_tried ?? [];
  const lists = /** @type {[string, string[]][]} */ ([
    [t`too weak to be seen with these data at usual strength`, record.cannot_exclude],
    [t`refused by the model at every strength`, record.refused],
    [t`no longer improves the evidence`, record.drop],
  ]);
  return html`
    <${Reasons}
      title=${t`Weighed with an assumed value, and therefore never named`}
      reasons=${byReason(untried.filter((effect) => weighed.has(effect.name)))}
    />
    <${Reasons}
      title=${t`Cannot be judged, as the experiment is described`}
      reasons=${byReason(untried.filter((effect) => !weighed.has(effect.name)))}
    />
    ${lists
      .filter(([, names]) => names.length > 0)
      .map(
        ([words, names]) => html`
          <details>
            <summary>${folded(names).length} ${words}</summary>
            <p>${folded(names).join(", ")}</p>
          </details>
        `,
      )}
  `;
}

function Reasons(/** @type {{ title: string, reasons: Reason[] }} */ { title, reasons }) {
  if (reasons.length === 0) return null;
  return html`
    <h2>${title}</h2>
    <ul>
      ${reasons.map(
        ({ names, why, needs }) => html`
          <li>
            <b>${folded(names).join(", ")}</b>: ${said(why)}.${" "}
            ${
              needs.startsWith("runs ")
                ? t`To be measured: ${translated(needs)}.`
                : html`To be stated: <code>${needs}</code>.`
            }
          </li>
        `,
      )}
    </ul>
  `;
}
