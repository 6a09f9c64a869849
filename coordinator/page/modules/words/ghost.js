// What an explanation would predict, from the fit of a search, before it is computed.

import { CHANNELS } from "./quantity.js";

/** A change of every prediction by less than this share of its error sd is not seen in the data. */
const LEAST_CHANGE = 0.1;

/** @typedef {Schemas["EffectCurves"] | null | undefined} Curves */

/**
 * The model, and the predictions of an explanation in its place.
 * @param {MeasuredRow[]} rows
 * @param {Curves} curves
 * @param {string | null} ghost
 */
export function withGhost(rows, curves, ghost) {
  const layers = [{ name: "model", colour: null, rows }];
  const values = ghost ? curves?.effects[ghost] : null;
  if (!curves || !values) return layers;
  const known = new Map(curves.data.map((d, k) => [`${d.run} ${d.channel}`, values[k]]));
  const own = rows.map((r) => ({ ...r, predicted: known.get(`${r.run} ${r.channel}`) ?? null, q05: null, q95: null }));
  return [...layers, { name: String(ghost), colour: "var(--ghost)", rows: own, isGhost: true }];
}

/**
 * The channels, those first that an explanation changes most compared with their errors.
 * @param {MeasuredRow[]} rows
 * @param {Curves} curves
 * @param {string | null} ghost
 */
export function byChange(rows, curves, ghost) {
  if (!ghost || !curves?.effects[ghost]) return CHANNELS;
  const changes = changesOf(errorsOf(rows), curves, ghost);
  return CHANNELS.toSorted((a, b) => (changes.get(b) ?? 0) - (changes.get(a) ?? 0));
}

/**
 * The explanations whose best fit predicts what the model without them predicts.
 * @param {MeasuredRow[]} rows
 * @param {Curves} curves
 * @returns {Set<string>}
 */
export function withoutChange(rows, curves) {
  if (!curves) return new Set();
  const errors = errorsOf(rows);
  const isUnchanged = (/** @type {string} */ name) => {
    const changes = changesOf(errors, curves, name);
    return changes.size > 0 && [...changes.values()].every((change) => change < LEAST_CHANGE);
  };
  return new Set(Object.keys(curves.effects).filter((name) => name !== "none" && isUnchanged(name)));
}

/** The error sd of each measurement. */
const errorsOf = (/** @type {MeasuredRow[]} */ rows) =>
  new Map(rows.map((row) => [`${row.run} ${row.channel}`, row.error_sd]));

/** The largest change of each channel by an explanation, in error sds; infinite where an error is not known. */
function changesOf(
  /** @type {Map<string, number | null | undefined>} */ errors,
  /** @type {NonNullable<Curves>} */ curves,
  /** @type {string} */ name,
) {
  const values = curves.effects[name];
  /** @type {Map<string, number>} */
  const changes = new Map();
  curves.data.forEach((datum, k) => {
    const difference = Math.abs(values[k] - curves.base[k]);
    const change = difference === 0 ? 0 : difference / (errors.get(`${datum.run} ${datum.channel}`) || 0);
    changes.set(datum.channel, Math.max(changes.get(datum.channel) ?? 0, change));
  });
  return changes;
}
