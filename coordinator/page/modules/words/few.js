// A list of which a few are named and the others counted.

import { t } from "../language/language.js";

/** So many are named. */
const NAMED = 3;

/** `a, b, c and 2 more`. */
export function few(/** @type {string[]} */ names) {
  const named = names.slice(0, NAMED).join(", ");
  return names.length > NAMED ? t`${named} and ${names.length - NAMED} more` : named;
}

/** The explanations that a run tells apart. */
export const separatedWords = (/** @type {string[]} */ separates) =>
  few(separates.map((name) => (name === "none" ? t`nothing missing` : name)));
