// The condition of a run as people read it, in the units that are shown.

import { t } from "../language/language.js";
import { slipUnit } from "../units.js";
import { digits, minus, shown } from "./quantity.js";

/** @typedef {{ slip: number, wheel_load_n: number, sled_speed_m_s: number }} Condition */

/** `0.3` or `30 %`. */
export const slipWords = (/** @type {number} */ slip) =>
  `${minus(Number((slip * slipUnit.scale).toPrecision(3)))}${slipUnit.unit === "1" ? "" : ` ${slipUnit.unit}`}`;

/** `90 N`. */
export const loadWords = (/** @type {number} */ load) => `${digits(load * shown("N").scale)} ${shown("N").unit}`;

/** `20 mm/s`. */
export const speedWords = (/** @type {number} */ speed) => `${digits(speed * shown("m/s").scale)} ${shown("m/s").unit}`;

/** `slip 0.3, 90 N, 20 mm/s`. */
export const conditionWords = (/** @type {Condition} */ run) =>
  t`slip ${slipWords(run.slip)}, ${loadWords(run.wheel_load_n)}, ${speedWords(run.sled_speed_m_s)}`;

/** The name of a run, and whether it was fitted. */
export const runName = (/** @type {{ run: string, use: string }} */ { run, use }) =>
  use === "holdout" ? t`run ${run} (held out)` : t`run ${run}`;
