// A long answer of the service by its clauses: the first ones, and the others folded.

import { html } from "../html.js";
import { clauses, sentence } from "../words/clauses.js";

/** Number of clauses that are shown at first. */
const FIRST = 3;

/** @param {{ text: string }} properties */
export function Clauses({ text }) {
  const all = clauses(text);
  const later = all.slice(FIRST);
  const paragraphs = (/** @type {string[]} */ some) => some.map((clause) => html`<p>${sentence(clause)}</p>`);
  return html`
    ${paragraphs(all.slice(0, FIRST))}
    ${later.length > 0 && html`<details><summary>More</summary>${paragraphs(later)}</details>`}
  `;
}
