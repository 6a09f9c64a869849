// How much of a calibration or of a search is done, from 0 to 1, by where its algorithm is; and how long the rest takes.

import { t } from "../language/language.js";
import { duration } from "./quantity.js";

/** Natural logarithm of the first tempering exponent of a usual calibration, about 1e-5; it rises to 0 over the stages. */
const FIRST_LN_EXPONENT = -11.5;
/** The share of a calibration's work until the exponent is 1. */
const CLIMB = 0.9;
/** The numbers of evaluations, steps and generations of usual searches, fits and evolutions. */
const USUAL = { search: 2000, fit: 8, evolution: 100 };
/** The end is not certain. */
const MOST = 0.99;
/** Less tells nothing of the time. */
const LEAST = 0.03;

const settling = (/** @type {number} */ done, /** @type {number} */ usual) => 1 - Math.exp(-done / usual);

/** The share that is done, as the terminal estimates it. */
export function shareOf(/** @type {any} */ { position, evaluations, step_done: done, step_size: size }) {
  const share = {
    search: () => settling(evaluations, USUAL.search),
    fit: () => settling(position.steps, USUAL.fit),
    evolution: () => settling(position.generations, USUAL.evolution),
    sampler: () => (position.tempering_exponent >= 1 ? CLIMB + ((1 - CLIMB) * done) / Math.max(1, size)
      : position.tempering_exponent > 0 ? CLIMB * Math.min(1, Math.max(0, 1 - Math.log(position.tempering_exponent) / FIRST_LN_EXPONENT)) : 0),
  }[/** @type {"search" | "fit" | "evolution" | "sampler"} */ (position.kind)];
  return Math.min(MOST, share ? share() : 0);
}

/**
 * `about 12 s to go`; nothing while too little is done since it was seen first.
 * @param {number} share now
 * @param {{ share: number, ms: number }} first the share when it was seen first, and when that was
 * @param {number} ms now
 */
export function toGo(share, first, ms) {
  const done = share - first.share;
  return done < LEAST ? "" : t`about ${duration(((ms - first.ms) / 1000) * ((1 - share) / done))} to go`;
}
