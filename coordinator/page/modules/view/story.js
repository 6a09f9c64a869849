import { html } from "../html.js";

/** @param {any} properties */
export function Story(properties) {
  return html`<p class="empty">Story</p>`;
}
