import { html } from "../html.js";

/** @param {any} properties */
export function Posterior(properties) {
  return html`<p class="empty">Posterior</p>`;
}
