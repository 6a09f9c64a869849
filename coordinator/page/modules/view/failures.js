import { html } from "../html.js";

/** @param {any} properties */
export function Failures(properties) {
  return html`<p class="empty">Failures</p>`;
}
