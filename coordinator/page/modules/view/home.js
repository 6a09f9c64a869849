import { html } from "../html.js";

/** @param {any} properties */
export function Home(properties) {
  return html`<p class="empty">Home</p>`;
}
