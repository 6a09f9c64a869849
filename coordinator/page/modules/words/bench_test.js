// A test without a rolling wheel, as a search proposes it.

import { raised } from "./quantity.js";

/** What to do, and where its result is stated in the files; null where nothing is stated. */
export function benchTest(/** @type {string} */ text) {
  const [what, place] = text.split(/\. Its result goes under /);
  return { what: raised(`${what}.`), place: place ?? null };
}
