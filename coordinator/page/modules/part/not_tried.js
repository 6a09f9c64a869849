// What the search cannot speak about: what the experiment does not state, what is too weak to see, what the model
// refuses.

import { html } from "../html.js";
import { t, translated } from "../language/language.js";
import { said } from "../words/clauses.js";

/** Names without `EFFECT.WHEEL` where `EFFECT` is in the list. */
function folded(/** @type {string[]} */ names) {
  return names.filter((name) => !name.includes(".") || !names.includes(name.split(".")[0]));
}

/** @param {{ record: Discovery }} properties */
export function NotTried({ record }) {
  /** @type {Map<string, { names: string[], why: string, needs: string }>} */
  const untried = new Map();
  for (const { name, why, needs } of record.not_tried ?? []) {
    const same = untried.get(`${why} ${needs}`) ?? { names: /** @type {string[]} */ ([]), why, needs };
    same.names.push(name);
    untried.set(`${why} ${needs}`, same);
  }
  const lists = /** @type {[string, string[]][]} */ ([
    [t`too weak to be seen with these data at usual strength`, record.cannot_exclude],
    [t`refused by the model at every strength`, record.refused],
    [t`no longer improves the evidence`, record.drop],
  ]);
  return html`
    ${
      untried.size > 0 &&
      html`
        <h2>Cannot be judged, as the experiment is described</h2>
        <ul>
          ${[...untried.values()].map(
            (same) => html`
              <li>
                <b>${folded(same.names).join(", ")}</b>: ${said(same.why)}.${" "}
                ${
                  same.needs.startsWith("runs ")
                    ? t`To be measured: ${translated(same.needs)}.`
                    : html`To be stated: <code>${same.needs}</code>.`
                }
              </li>
            `,
          )}
        </ul>
      `
    }
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
