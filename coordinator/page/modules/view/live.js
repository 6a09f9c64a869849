import { html } from "../html.js";

/** @param {any} properties */
export function Live(properties) {
  return html`<p class="empty">Live</p>`;
}
