// Levels of a condition: what a rig was set to, from values that repeat, scatter or are typed with rounding.

import { minus } from "./quantity.js";
import { t } from "../language/language.js";

/** Values closer than this share of the value are equal: rig settings that were typed or computed with rounding. */
const EQUAL = 0.005;
/** Levels that are not further apart than this share of the value are readings of one setting. */
const READING = 0.02;
/** Readings that are not further apart than this share of the value are scatter about one setting. */
const SCATTER = 0.05;
/**
 * Levels of which fewer runs than this share have company are no levels, but single values, unless they lie far apart.
 */
const REPEATED = 0.75;
/** A greater ratio of neighbouring values lies far apart. */
const FAR = 1.15;
/** A picture has no more levels. */
const MAX_LEVELS = 60;

/** @typedef {{ low: number, high: number, count: number }} Level */

/**
 * Levels of a positive quantity, ascending: groups of values that the gaps between them set apart. Settings that are
 * repeated, such as 100, 110 and 120 N, are a level each; readings that scatter about settings are a level for each
 * setting; readings without gaps are one level. Of all ways to cut at the widest gaps, the one is taken whose gaps are
 * widest compared with the extents of the levels.
 * @param {number[]} values
 * @returns {Level[]}
 */
export function levels(values) {
  const ascending = [...values].sort((a, b) => a - b);
  if (ascending.length === 0) return [];
  const settings = cut(ascending, (low) => EQUAL * low);
  if (isRepeated(settings) && apartness(settings) > 1) return settings;
  const gaps = new Set(ascending.slice(1).map((value, k) => value - ascending[k]));
  const whole = cut(ascending, () => Infinity);
  return [...[...gaps].sort((a, b) => b - a).slice(0, MAX_LEVELS), 0]
    .map((widest) => cut(ascending, () => widest))
    .filter((found) => isBeyond(found, FAR) || (isBeyond(found, 1 + SCATTER) && isRepeated(found)))
    .reduce((best, found) => (apartness(found) > Math.max(1, apartness(best)) ? found : best), whole);
}

/** Ascending values, cut where a gap is wider than what still belongs together above a value. */
function cut(/** @type {number[]} */ ascending, /** @type {(low: number) => number} */ widest) {
  /** @type {Level[]} */
  const found = [];
  for (const value of ascending) {
    const last = found.at(-1);
    if (last && value - last.high <= widest(last.high)) {
      last.high = value;
      last.count += 1;
    } else {
      found.push({ low: value, high: value, count: 1 });
    }
  }
  return found;
}

/** Whether most runs of the levels are not alone. */
function isRepeated(/** @type {Level[]} */ all) {
  const count = (/** @type {Level[]} */ some) => some.reduce((sum, level) => sum + level.count, 0);
  return count(all.filter((level) => level.count > 1)) >= REPEATED * count(all);
}

/** Neighbouring levels. */
const neighbours = (/** @type {Level[]} */ all) => all.slice(1).map((above, k) => ({ below: all[k], above }));

/** Whether every level begins beyond a multiple of the end of the level below it. */
const isBeyond = (/** @type {Level[]} */ all, /** @type {number} */ ratio) =>
  neighbours(all).every(({ below, above }) => above.low > ratio * below.high);

/** The least gap between neighbouring levels over their extent, or over what a reading may differ; 0 of one level. */
function apartness(/** @type {Level[]} */ all) {
  const ratios = neighbours(all).map(
    ({ below, above }) =>
      (above.low - below.high) / Math.max(below.high - below.low, above.high - above.low, READING * below.high),
  );
  return ratios.length === 0 ? 0 : Math.min(...ratios);
}

/** The place of a value among levels. */
export const levelOf = (/** @type {Level[]} */ all, /** @type {number} */ value) =>
  all.findIndex(({ low, high }) => value >= low && value <= high);

/**
 * `60 N`, `21 to 27 N`: with a digit more where two do not tell the ends apart; `≈ 14.1 mm/s` of scatter about one
 * setting.
 */
export function levelWords(
  /** @type {{ low: number, high: number }} */ { low, high },
  /** @type {string} */ unit,
  scale = 1,
) {
  const rounded = (/** @type {number} */ value, /** @type {number} */ count) =>
    minus(Number((value * scale).toPrecision(count)));
  if (high - low <= SCATTER * high)
    return `${high - low <= EQUAL * high ? "" : "≈ "}${rounded((low + high) / 2, 3)} ${unit}`;
  const step = 10 ** (Math.floor(Math.log10(high)) - 1);
  return `${[low, high].map((value) => rounded(value, high - low < step ? 3 : 2)).join(t` to `)} ${unit}`;
}
