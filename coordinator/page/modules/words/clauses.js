// The clauses of a sentence of the service.

import { capital, raised } from "./quantity.js";

/** A text as a sentence, with numbers and units as people write them. */
export const sentence = (/** @type {string} */ text) => capital(raised(/[.!?]$/.test(text) ? text : `${text}.`));

/** The parts between the semicolons of a text; those within brackets belong to their part. */
export function clauses(/** @type {string} */ text) {
  let depth = 0;
  /** @type {string[]} */
  const parts = [""];
  for (const part of text.split(/([()[\]]|; )/)) {
    if ("([".includes(part) && part !== "") depth += 1;
    if (")]".includes(part) && part !== "") depth = Math.max(0, depth - 1);
    if (part === "; " && depth === 0) parts.push("");
    else parts[parts.length - 1] += part;
  }
  return parts;
}
