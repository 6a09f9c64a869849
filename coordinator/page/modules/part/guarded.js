// A part that fails alone: what stands beside it stays.

import { html, useErrorBoundary } from "../html.js";

/** @param {{ title: string, children?: unknown }} properties */
export function Guarded({ title, children }) {
  const [error] = useErrorBoundary();
  return error ? html`<p class="error" role="alert">${title} cannot be shown: ${error.message}.</p>` : children;
}
