import { html } from "../html.js";

/** @param {any} properties */
export function Compare(properties) {
  return html`<p class="empty">Compare</p>`;
}
