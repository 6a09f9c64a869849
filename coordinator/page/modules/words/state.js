// States and progress as people read them.

import { t } from "../language/language.js";
import { digits, duration } from "./quantity.js";

/** How far a calibration has come: `stage 5, exponent 0.012, 2300 evaluations, about 12 s to go`. */
export function progressWords(/** @type {Progress} */ progress) {
  const parts = [...positionWords(progress.position), t`${progress.evaluations} evaluations`];
  if (typeof progress.remaining_s === "number") parts.push(t`about ${duration(progress.remaining_s)} to go`);
  return parts.join(", ");
}

/** Where an algorithm is, by its kind. */
function positionWords(/** @type {Progress["position"]} */ position) {
  switch (position.kind) {
    case "sampler": {
      const climbs = position.stage > 0 && position.tempering_exponent < 1;
      return [t`stage ${position.stage}`, ...(climbs ? [t`exponent ${digits(position.tempering_exponent, 2)}`] : [])];
    }
    case "fit":
      return [t`step ${position.steps}`];
    case "evolution":
      return [t`generation ${position.generations}`];
    case "search":
      return [t`round ${position.rounds}`];
    default:
      return [];
  }
}

/** How long ago something was heard of. */
export const ago = (/** @type {number} */ ms) => (ms < 1500 ? t`now` : t`${duration(ms / 1000)} ago`);
