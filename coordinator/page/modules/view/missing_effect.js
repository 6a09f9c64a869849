import { html } from "../html.js";

/** @param {any} properties */
export function MissingEffect(properties) {
  return html`<p class="empty">MissingEffect</p>`;
}
