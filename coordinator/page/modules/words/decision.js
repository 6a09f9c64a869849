// Losses of a decision as people read them, with the digits of the terminal.

import { slipUnit } from "../units.js";
import { minus, power } from "./quantity.js";

/** From this absolute value on, and beyond this many leading decimals, a number has an exponent, as in the terminal. */
const LARGE = 1e7;
const DECIMALS = 7;

/**
 * A number rounded to a count of significant digits by the rule of the terminal: whole tens and hundreds have zeros.
 */
export function significant(/** @type {number | null | undefined} */ value, /** @type {number} */ count) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const decimals = count - 1 - Math.floor(Math.log10(Math.abs(value)));
  if (Math.abs(value) >= LARGE || decimals > DECIMALS + count) {
    const [factor, exponent] = value.toExponential(count - 1).split("e");
    return `${minus(factor)}·${power(Number(exponent))}`;
  }
  if (decimals >= 0) return minus(value.toFixed(decimals));
  const step = 10 ** -decimals;
  return minus(Math.round(value / step) * step);
}

/** A loss; its unit is that of the decision's formula. */
export const loss = (/** @type {number | null | undefined} */ value) => significant(value, 4);

/** `1264 ± 3.2`: an expected loss with its standard error. */
export const lossWithError = (/** @type {{ expected_loss: number, expected_loss_se: number }} */ option) =>
  `${loss(option.expected_loss)} ± ${significant(option.expected_loss_se, 2)}`;

/** A share as `45 %`. */
export const percent = (/** @type {number} */ share) => `${(100 * share).toFixed(0)} %`;

/** A slip to a hundredth, in the unit that is shown. */
export const slipDigits = (/** @type {number | null | undefined} */ slip) =>
  slip === null || slip === undefined
    ? "–"
    : slipUnit.unit === "1"
      ? slip.toFixed(2)
      : `${(slip * slipUnit.scale).toFixed(0)} ${slipUnit.unit}`;
