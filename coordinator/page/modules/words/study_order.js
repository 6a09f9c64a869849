// Orders of a list of studies, and the studies that have some words.

import { t } from "../language/language.js";

/**
 * The error of a study's current model over the noise: on held-out runs where there are any. Studies without one stand
 * last.
 */
const errorOf = (/** @type {Pick<ListedStudy, "error">} */ { error }, /** @type {number} */ sign) =>
  sign * ((error?.holdout ?? error?.fit)?.all.rmse_fixed_sigma ?? sign * Infinity);

/** @type {Record<string, (a: ListedStudy, b: ListedStudy) => number>} */
export const ORDERS = {
  [t`newest first`]: (a, b) => b.id - a.id,
  [t`oldest first`]: (a, b) => a.id - b.id,
  [t`by name`]: (a, b) => String(a.name).localeCompare(String(b.name)) || b.id - a.id,
  [t`by author`]: (a, b) =>
    String(a.details.author ?? "\uffff").localeCompare(String(b.details.author ?? "\uffff")) || b.id - a.id,
  [t`smallest error first`]: (a, b) => compared(errorOf(a, 1), errorOf(b, 1)) || b.id - a.id,
  [t`largest error first`]: (a, b) => compared(errorOf(a, -1), errorOf(b, -1)) || b.id - a.id,
};

const compared = (/** @type {number} */ a, /** @type {number} */ b) => (a === b ? 0 : a - b);

/** What a study can be found by. */
const textOf = (/** @type {ListedStudy} */ study) =>
  [
    study.name,
    `study ${study.id}`,
    study.state,
    study.model_kind,
    ...study.effects,
    study.details.author,
    ...study.details.tags,
    study.verdict?.short,
    study.models,
  ]
    .filter(Boolean)
    .join(" ")
    .toLowerCase()
    .replaceAll("_", " ");

/**
 * The studies that have every word, in an order.
 * @param {ListedStudy[]} studies
 * @param {string} text
 * @param {string} order a name of `ORDERS`
 */
export function listed(studies, text, order) {
  const words = text.toLowerCase().replaceAll("_", " ").split(/\s+/).filter(Boolean);
  return studies.filter((study) => words.every((word) => textOf(study).includes(word))).sort(ORDERS[order]);
}
