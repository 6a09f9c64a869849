// A view that fails does not take the others along: it says what happened.

import { html, useErrorBoundary } from "../html.js";

/** @param {{ what: string, children?: any }} properties what: the view, as people know it */
export function Guard({ what, children }) {
  const [error, again] = useErrorBoundary();
  if (!error) return children;
  return html`
    <p class="error" role="alert">${what} cannot be shown: ${error.message}</p>
    <p><button type="button" onClick=${again}>Try again</button></p>`;
}
