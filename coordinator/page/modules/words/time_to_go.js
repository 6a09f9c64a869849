// How long the rest of a calibration or of a search takes, by the share of it that the service says is done.

import { t } from "../language/language.js";
import { duration } from "./quantity.js";

/** A smaller share tells nothing of the time. */
const LEAST = 0.03;

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
