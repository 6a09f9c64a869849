import { html } from "../html.js";

/** @param {any} properties */
export function NewCalibration(properties) {
  return html`<p class="empty">NewCalibration</p>`;
}
