// The units in which quantities are shown: those that a person chose. Files and the service have SI.

import { kept } from "./kept.js";

/** Sets of units, by name: how a unit in SI is shown, and what one is in it. */
const SETS = /** @type {Record<string, Record<string, { unit: string, scale: number }>>} */ ({
  "N, mm, kPa": {
    m: { unit: "mm", scale: 1000 },
    Pa: { unit: "kPa", scale: 0.001 },
    "m/s": { unit: "mm/s", scale: 1000 },
  },
  "kN, mm, kPa": {
    m: { unit: "mm", scale: 1000 },
    Pa: { unit: "kPa", scale: 0.001 },
    "m/s": { unit: "mm/s", scale: 1000 },
    N: { unit: "kN", scale: 0.001 },
    "N m": { unit: "kN m", scale: 0.001 },
  },
  "lbf, in, psi": {
    m: { unit: "in", scale: 1 / 0.0254 },
    Pa: { unit: "psi", scale: 1 / 6894.757293168 },
    "m/s": { unit: "in/s", scale: 1 / 0.0254 },
    N: { unit: "lbf", scale: 1 / 4.4482216152605 },
    "N m": { unit: "lbf ft", scale: 1 / 1.3558179483314 },
  },
});

export const UNIT_SETS = Object.keys(SETS);
/** Ways to write a slip. */
export const SLIPS = ["0.3", "30 %"];

const set = kept("units", UNIT_SETS);
const slip = kept("slip", SLIPS);

/** What is chosen, and how it is changed; the page begins anew. */
export const chosenUnits = { set: set.value, chooseSet: set.change, slip: slip.value, chooseSlip: slip.change };

/** How a unit in SI is shown; null: as it is. */
export const shownUnit = (/** @type {string} */ unit) => SETS[set.value][unit] ?? null;

/** How a slip is shown. */
export const slipUnit = slip.value === SLIPS[1] ? { unit: "%", scale: 100 } : { unit: "1", scale: 1 };
