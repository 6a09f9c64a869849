// What an explanation would predict, from the fit of a search, before it is computed.

import { CHANNELS } from "./quantity.js";

/**
 * The model, and the predictions of an explanation in its place.
 * @param {any[]} rows
 * @param {any} curves
 * @param {string | null} ghost
 */
export function withGhost(rows, curves, ghost) {
  const layers = [{ name: "model", colour: null, rows }];
  const values = ghost ? curves?.effects?.[ghost] : null;
  if (!values) return layers;
  const known = new Map(curves.data.map((/** @type {any} */ d, /** @type {number} */ k) => [`${d.run} ${d.channel}`, values[k]]));
  const own = rows.map((r) => ({ ...r, predicted: known.get(`${r.run} ${r.channel}`) ?? null, q05: null, q95: null }));
  return [...layers, { name: String(ghost), colour: "var(--ghost)", rows: own, isGhost: true }];
}

/**
 * The channels, those first that an explanation changes most compared with their errors.
 * @param {any[]} rows
 * @param {any} curves
 * @param {string | null} ghost
 */
export function byChange(rows, curves, ghost) {
  const values = ghost ? curves?.effects?.[ghost] : null;
  if (!values) return CHANNELS;
  const sds = new Map(rows.map((row) => [`${row.run} ${row.channel}`, row.error_sd]));
  /** @type {Map<string, number>} */
  const changes = new Map();
  curves.data.forEach((/** @type {any} */ d, /** @type {number} */ k) => {
    const change = Math.abs(values[k] - curves.base[k]) / (sds.get(`${d.run} ${d.channel}`) || Infinity);
    changes.set(d.channel, Math.max(changes.get(d.channel) ?? 0, change));
  });
  return CHANNELS.toSorted((a, b) => (changes.get(b) ?? 0) - (changes.get(a) ?? 0));
}
