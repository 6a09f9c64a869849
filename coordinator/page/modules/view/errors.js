import { html } from "../html.js";

/** @param {any} properties */
export function Errors(properties) {
  return html`<p class="empty">Errors</p>`;
}
