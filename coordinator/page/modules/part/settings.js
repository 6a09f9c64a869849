// Language and units of the page: kept in this browser.

import { html } from "../html.js";
import { choose, decimal, language, LANGUAGES, t } from "../language/language.js";
import { chosenUnits, SLIPS, UNIT_SETS } from "../units.js";

export function Settings() {
  const options = (/** @type {[string, string][]} */ all, /** @type {string} */ now) =>
    all.map(([value, name]) => html`<option value=${value} selected=${value === now}>${name}</option>`);
  const same = (/** @type {string[]} */ values) =>
    values.map((value) => /** @type {[string, string]} */ ([value, value]));
  return html`
    <div class="settings" role="group" aria-label="Language and units">
      <select aria-label="Language" onChange=${(/** @type {SelectEvent} */ e) => choose(e.currentTarget.value)}>
        ${options(Object.entries(LANGUAGES), language)}
      </select>
      <select
        aria-label="Units"
        onChange=${(/** @type {SelectEvent} */ e) => chosenUnits.chooseSet(e.currentTarget.value)}
      >
        ${options(same(UNIT_SETS), chosenUnits.set)}
      </select>
      <select
        aria-label="Slip as"
        onChange=${(/** @type {SelectEvent} */ e) => chosenUnits.chooseSlip(e.currentTarget.value)}
      >
        ${options(
          SLIPS.map((slip) => /** @type {[string, string]} */ ([slip, t`slip ${decimal(slip)}`])),
          chosenUnits.slip,
        )}
      </select>
    </div>
  `;
}
