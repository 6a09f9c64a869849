// What stands where nothing else does: a wait, an error, an empty place; each says what to do.

import { html } from "../html.js";

/** @param {{ answer: unknown, error: any, children?: unknown, what: string }} properties */
export function Pending({ answer, error, what }) {
  if (error && error.status === 409) return html`<p class="empty">${error.message}.</p>`;
  if (error) return html`<p class="error" role="alert">${what}: ${error.message}</p>`;
  return html`<p class="empty" aria-busy="true">Loading ${what} …</p>`;
}

/** @param {{ error: any }} properties */
export function Failure({ error }) {
  return error ? html`<p class="error" role="alert">${error.message}</p>` : null;
}

/** @param {{ children?: unknown }} properties */
export const Empty = ({ children }) => html`<p class="empty">${children}</p>`;
