// Parameters as people read them. A job may have the logarithm of a quantity (`log10_p_ref`, in log10 Pa): people read
// the quantity itself, on logarithmic axes, with its sd as a factor.

import { meanAndSd, digits, parameterName, shown, titled, withSd } from "./quantity.js";

/**
 * @typedef {{ name: string, unit: string, isLogarithm: boolean, of: (value: number) => number }} ShownParameter unit:
 *   blank of a pure number. of: from a value in SI to that in the unit.
 */

/**
 * How a parameter is shown.
 * @param {{ name: string, unit?: string | null }} parameter unit: in SI; nothing where it is not known
 * @returns {ShownParameter}
 */
export function shownParameter({ name, unit }) {
  const [, base] = /^log10 (.+)$/.exec(unit ?? "") ?? [];
  const { unit: word, scale } = unit ? shown(base ?? unit) : { unit: "1", scale: 1 };
  const quantity = base === undefined ? name : name.replace(/(^|\.)log10_/, "$1");
  return {
    name: parameterName(quantity, base ?? unit),
    unit: word === "1" ? "" : word,
    isLogarithm: base !== undefined,
    of: (value) => (base === undefined ? value : 10 ** value) * scale,
  };
}

/** `p ref [kPa]`. */
export function parameterTitle(/** @type {{ name: string, unit?: string | null }} */ parameter) {
  const { name, unit } = shownParameter(parameter);
  return titled(name, unit);
}

/** A value with its unit: `45.7 kPa`. */
export function parameterValue(
  /** @type {{ name: string, unit?: string | null }} */ parameter,
  /** @type {number} */ value,
  count = 3,
) {
  const { unit, of } = shownParameter(parameter);
  return `${digits(of(value), count)}${unit === "" ? "" : ` ${unit}`}`;
}

/** The sd of a parameter in the unit that is shown, for small sds of a logarithm. */
const sdOf = (
  /** @type {ShownParameter} */ { isLogarithm, of },
  /** @type {number} */ mean,
  /** @type {number} */ sd,
) => (isLogarithm ? of(mean) * Math.LN10 * sd : Math.abs(of(sd)));

/**
 * Mean and sd: `9.4 ± 0.6`; of a logarithm `45.7 ×/÷ 1.06`, the mean of the logarithm and the factor that one sd is.
 */
export function meanAndSpread(
  /** @type {ShownParameter} */ parameter,
  /** @type {number} */ mean,
  /** @type {number} */ sd,
) {
  const here = meanAndSd(parameter.of(mean), sdOf(parameter, mean, sd));
  return parameter.isLogarithm
    ? `${10 ** sd < 1.5 ? here.mean : digits(parameter.of(mean))} ×/÷ ${digits(10 ** sd)}`
    : `${here.mean} ± ${here.sd}`;
}

/** Values with the digits of the parameter's sd. */
export function parameterValues(
  /** @type {ShownParameter} */ parameter,
  /** @type {(number | null)[]} */ values,
  /** @type {number} */ mean,
  /** @type {number} */ sd,
) {
  return withSd(
    values.map((value) => (value === null ? null : parameter.of(value))),
    sdOf(parameter, mean, sd),
  );
}
