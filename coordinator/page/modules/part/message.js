// What stands where nothing else does: a wait, an error, an empty place; each says what to do.

import { html, useEffect, useState } from "../html.js";
import { AnswerError } from "../rest/answers.js";

/** A wait that is longer has a reason [ms]. */
const LONG_MS = 1500;

/** @param {{ answer: unknown, error: Error | null, children?: unknown, what: string }} properties */
export function Pending({ error, what }) {
  if (error instanceof AnswerError && error.status === 409) return html`<p class="empty">${error.message}.</p>`;
  if (error) return html`<p class="error" role="alert">${what}: ${error.message}</p>`;
  return html`<${Wait} what=${what} />`;
}

function Wait(/** @type {{ what: string }} */ { what }) {
  const [isLong, setLong] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setLong(true), LONG_MS);
    return () => clearTimeout(timer);
  }, []);
  return html`
    <p class="empty" aria-busy="true">Loading ${what} …</p>
    ${
      isLong &&
      html`
        <p class="note">It is computed when it is first asked for, beside the calibrations at work, and kept then.</p>
      `
    }
  `;
}

/** @param {{ error: Error | null }} properties */
export function Failure({ error }) {
  return error ? html`<p class="error" role="alert">${error.message}</p>` : null;
}

/** @param {{ children?: unknown }} properties */
export const Empty = ({ children }) => html`<p class="empty">${children}</p>`;
