// Losses of a decision as people read them, with the digits of the terminal.

import { slipUnit } from "../units.js";
import { digits } from "./quantity.js";

/** A loss; its unit is that of the decision's formula. */
export const loss = (/** @type {number | null | undefined} */ value) => digits(value, 4);

/** `1264 ± 3.2`: an expected loss with its standard error. */
export const lossWithError = (/** @type {{ expected_loss: number, expected_loss_se: number }} */ option) => `${loss(option.expected_loss)} ± ${digits(option.expected_loss_se, 2)}`;

/** A share as `45 %`. */
export const percent = (/** @type {number} */ share) => `${(100 * share).toFixed(0)} %`;

/** A slip to a hundredth, in the unit that is shown. */
export const slipDigits = (/** @type {number | null | undefined} */ slip) => (slip === null || slip === undefined ? "–" : slipUnit.unit === "1" ? slip.toFixed(2) : `${(slip * slipUnit.scale).toFixed(0)} ${slipUnit.unit}`);
