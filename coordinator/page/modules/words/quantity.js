// Quantities as people read them: their names, units and digits.

import { decimal, t, translatedParameter } from "../language/language.js";
import { shownUnit } from "../units.js";

/** How a unit in SI is shown: in the units that a person chose. */
export const shown = (/** @type {string} */ unit) =>
  shownUnit(unit) ?? { unit: raised(unit.replace(/^deg$/, "°")), scale: 1 };

const SHORT = { drawbar_pull: t`pull`, torque: t`torque`, sinkage: t`sinkage`, lateral_force: t`lateral force` };
const NAMES = { ...SHORT, drawbar_pull: t`drawbar pull`, transient_sinkage: t`sinkage before it is steady` };
const UNITS = { drawbar_pull: "N", torque: "N m", sinkage: "m", lateral_force: "N", transient_sinkage: "m" };

/** The channels in their order. */
export const CHANNELS = /** @type {const} */ (["drawbar_pull", "torque", "sinkage", "lateral_force"]);

/**
 * Units and numbers in a text of the service as people write them: `kg/m³`, `7·10⁻⁷`, `−0.5`. A number with nine
 * decimals or more, which is written to the last digit, has four digits, or its whole part.
 */
export const raised = (/** @type {string} */ text) =>
  text
    .replace(/\^([23])/g, (_, exponent) => (exponent === "2" ? "²" : "³"))
    .replace(/\d+\.\d{9,}(?!\d*e)/g, (number) =>
      String(Number(Number(number).toPrecision(Math.max(4, number.indexOf("."))))),
    )
    .replace(
      /(?<![\w.]|\w-)(\d+(?:\.\d+)?)e([+-]?\d+)(?!\w)/g,
      (_, factor, exponent) => `${factor === "1" ? "" : `${factor}·`}${power(Number(exponent))}`,
    )
    .replace(/(?<=^|[\s(])-(?=\d)/g, "−");

/** `drawbar_pull` as words. */
export const words = (/** @type {string} */ name) => name.replaceAll("_", " ");

/** A sentence begins with a capital, unless it begins with a name of the program or a symbol. */
export const capital = (/** @type {string} */ text) =>
  /^([a-z0-9]*_|[a-z]\d?(,| and | is | lies ))/.test(text) ? text : text.charAt(0).toUpperCase() + text.slice(1);

/** How names of parameters spell a unit at their end: `Pa/m` as `pa_m`, `1/m` as `per_m`, `kg/m^3` as `kg_m3`. */
const spelt = (/** @type {string} */ unit) =>
  unit
    .toLowerCase()
    .replace(/^1\//, "per_")
    .replaceAll("^", "")
    .replace(/[^a-z0-9]+/g, "_");

/**
 * The name of a parameter as words, without the unit that it ends with before the name of a wheel, because the unit
 * stands beside it; whole where its unit is not known.
 * @param {string} name
 * @param {string | null | undefined} unit in SI
 */
export function parameterName(name, unit) {
  const bare = unit && unit !== "1" ? name.replace(new RegExp(`_${spelt(unit)}(?=\\.[^.]*$|$)`), "") : name;
  return bare
    .split(".")
    .map((part) => translatedParameter(words(part)))
    .join(": ");
}

/** A number that a person typed, with a point or a comma; null where it is none. */
export function numberOf(/** @type {string} */ text) {
  const plain = text
    .trim()
    .replace("−", "-")
    .replace(/^([^.,]*),([^.,]*)$/, "$1.$2");
  return plain === "" || !Number.isFinite(Number(plain)) ? null : Number(plain);
}

/** A short name of a channel. */
export const short = (/** @type {string} */ channel) =>
  SHORT[/** @type {keyof typeof SHORT} */ (channel)] ?? words(channel);

/** The name of a channel. */
export const channelName = (/** @type {string} */ channel) =>
  NAMES[/** @type {keyof typeof NAMES} */ (channel)] ?? words(channel);

/** The unit of a channel in SI. */
export const unitOf = (/** @type {string} */ channel) => UNITS[/** @type {keyof typeof UNITS} */ (channel)] ?? "1";

/** `drawbar pull [N]`; a dimensionless quantity has no bracket. */
export function titled(/** @type {string} */ name, /** @type {string} */ unit) {
  return unit === "1" || unit === "" ? name : `${name} [${unit}]`;
}

/** A number to a count of significant digits, without an exponent where it needs none. */
export function digits(/** @type {number | null | undefined} */ value, count = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size >= 5 || size <= -4) {
    const factor = Number((value / 10 ** size).toPrecision(Math.max(1, count - 1)));
    return `${minus(factor)}·${power(size)}`;
  }
  return minus(value.toFixed(Math.max(0, count - 1 - size)));
}

/** An error in the unit that is shown, as the sentences of the story write it. */
export const errorWords = (/** @type {number | null | undefined} */ value) => digits(value, (value ?? 0) < 1 ? 2 : 3);

/** A number at a tick of an axis, with an exponent where it is large or small. */
export function tickWords(/** @type {number} */ value) {
  const size = Math.abs(value);
  return value !== 0 && (size >= 1e5 || size < 1e-3) ? digits(value, 3) : minus(Number(value.toPrecision(6)));
}

/** A value of a unit in SI as people read it: `3.5 mm`. */
export function size(/** @type {number | null | undefined} */ value, /** @type {string} */ unit, count = 3) {
  if (value === null || value === undefined) return "–";
  const quantity = shown(unit);
  return `${digits(value * quantity.scale, count)}${quantity.unit === "1" ? "" : ` ${quantity.unit}`}`;
}

/** The decimals of the second digit of an sd; null where they say little. */
function decimalsOf(/** @type {number} */ mean, /** @type {number} */ sd) {
  const decimals = sd > 0 ? Math.max(0, 1 - Math.floor(Math.log10(sd))) : Infinity;
  return decimals > 8 || Math.abs(mean) >= 1e6 ? null : decimals;
}

/** Values of a quantity to the second digit of its sd. */
export function withSd(/** @type {(number | null)[]} */ values, /** @type {number} */ sd) {
  const decimals = decimalsOf(Math.max(...values.map((value) => Math.abs(value ?? 0))), sd);
  return values.map((value) =>
    value === null || decimals === null ? digits(value, 4) : minus(value.toFixed(decimals)),
  );
}

/** Mean and sd: both to the second digit of the sd. */
export function meanAndSd(/** @type {number} */ mean, /** @type {number} */ sd) {
  const decimals = decimalsOf(mean, sd);
  if (decimals === null) return { mean: digits(mean, 4), sd: digits(sd, 2) };
  return { mean: minus(mean.toFixed(decimals)), sd: minus(sd.toFixed(decimals)) };
}

/** A probability: `0.97`, `> 0.999`, `< 0.001`. */
export function probability(/** @type {number} */ p) {
  if (p > 0.999) return decimal("> 0.999");
  if (p < 0.001) return decimal("< 0.001");
  return decimal(p.toFixed(p > 0.99 || p < 0.01 ? 3 : 2));
}

/** A duration: `12 s`, `3 min`, `2.5 h`. */
export function duration(/** @type {number} */ seconds) {
  if (seconds < 90) return `${Math.max(1, Math.round(seconds))} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${decimal((seconds / 3600).toFixed(1))} h`;
}

/** With the sign and the decimal mark that people write. */
export const minus = (/** @type {number | string} */ value) => decimal(String(value).replace("-", "−"));

/** Ten to a power, raised: 10⁻³. */
export function power(/** @type {number} */ exponent) {
  const raised = [..."⁰¹²³⁴⁵⁶⁷⁸⁹"];
  const figures = [...String(Math.abs(exponent))].map((figure) => raised[Number(figure)]);
  return `10${exponent < 0 ? "⁻" : ""}${figures.join("")}`;
}
