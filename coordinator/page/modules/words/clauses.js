// The clauses of a sentence of the service.

import { told } from "../language/language.js";
import { capital, raised } from "./quantity.js";

/**
 * A text of the service in the language of the page, with numbers and units as people write them: a line does not end
 * between them.
 */
export const said = (/** @type {string} */ text) =>
  told(raised(text)).replace(/([<>=]|\bP) (?=[\d>< ])|(\d) (?=(?:N|mm|m|kN|kg)\b)/g, "$1$2\u00a0");

/** The same as a sentence. */
export const sentence = (/** @type {string} */ text) => capital(/[.!?]$/.test(text) ? said(text) : `${said(text)}.`);

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
