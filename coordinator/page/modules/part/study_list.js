// The list of studies: found by words, in a chosen order, a page at a time.

import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { listed, ORDERS } from "../words/study_order.js";
import { StudyTable } from "./study_table.js";

/** Number of studies that are shown at first: the table of hundreds is slow to draw, and the newest stand first. */
const FIRST = 50;
/** Fewer studies need no search. */
const LEAST = 4;

/** @param {{ studies: ListedStudy[] }} properties */
export function StudyList({ studies }) {
  const [text, setText] = useState("");
  const [order, setOrder] = useState(Object.keys(ORDERS)[0]);
  const [isAll, setAll] = useState(false);
  const found = listed(studies, text, order);
  const shown = isAll ? found : found.slice(0, FIRST);
  return html`
    ${
      studies.length >= LEAST &&
      html`
        <div class="actions" role="search">
          <label>
            Find <input
              type="search"
              size="26"
              value=${text}
              placeholder="name, author, tag, effect"
              onInput=${(/** @type {FieldEvent} */ e) => setText(e.currentTarget.value)}
            />
          </label>
          <label>
            Order <select value=${order} onChange=${(/** @type {SelectEvent} */ e) => setOrder(e.currentTarget.value)}>
              ${Object.keys(ORDERS).map(
                (name) => html`<option value=${name} selected=${name === order}>${name}</option>`,
              )}
            </select>
          </label>
          <span class="note" role="status">
            ${
              found.length === studies.length
                ? t`${studies.length} studies`
                : t`${found.length} of ${studies.length} studies`
            }
          </span>
        </div>
      `
    }
    ${
      found.length > 0
        ? html`<${StudyTable} studies=${shown} choose=${setText} />`
        : html`<p class="empty">No study has these words.</p>`
    }
    ${
      found.length > shown.length &&
      html`<button type="button" onClick=${() => setAll(true)}>Show all ${found.length}</button>`
    }
  `;
}
