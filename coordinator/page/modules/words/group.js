// Runs of like conditions: what belongs on one line of a picture.

import { t } from "../language/language.js";
import { slipUnit } from "../units.js";
import { slipWords } from "./condition.js";
import { levelOf, levels, levelWords } from "./level.js";
import { shown } from "./quantity.js";

/** A wheel at rest has no ratio to others [m/s]. */
const LEAST_SPEED = 1e-9;

/**
 * @typedef {{ run: string, wheel: string, slip: number, wheel_load_n: number, sled_speed_m_s: number, slip_angle_deg:
 *   number }} Condition
 */

/** The speed of the rim [m/s], from slip and sled speed. */
export function rimSpeed(/** @type {Pick<Condition, "slip" | "sled_speed_m_s">} */ { slip, sled_speed_m_s }) {
  return slip >= 0 ? sled_speed_m_s / (1 - slip) : sled_speed_m_s * (1 + slip);
}

/**
 * @template {Condition} R
 * @typedef {{ colour: number, symbol: number, rows: R[] }} Group
 */

/**
 * @typedef {{ names: string[], of: (row: Condition) => number }} Factor the levels of a condition by name, and the
 *   place of a row among them
 */

/**
 * Groups rows whose conditions are equal but for one, against which they are drawn. The colour of a group is its wheel
 * load, or its slip where runs are drawn against the load, or the condition with most levels where that one has a
 * single level; its symbol tells the other conditions that were set to several levels.
 * @template {Condition} R
 * @param {R[]} rows
 * @param {string} against key of the condition that a group goes through
 * @returns {{ groups: Group<R>[], colours: string[], symbols: string[], colourKey: string, single: string | null }}
 *   groups in the order of their levels, with the names of these; colourKey: the condition that colours tell; single:
 *   the one level of the usual one, if it has one
 */
export function groups(rows, against = "slip") {
  const factors = {
    slip: slips(rows),
    wheel_load_n: loads(rows),
    sled_speed_m_s: speeds(rows),
    slip_angle_deg: angles(rows),
  };
  const usual = against === "wheel_load_n" ? "slip" : "wheel_load_n";
  const free = Object.entries(factors).filter(([key]) => key !== against);
  const widest = free.reduce(
    (best, factor) => (factor[1].names.length > best[1].names.length ? factor : best),
    [usual, factors[usual]],
  );
  const [colourKey, first] = factors[usual].names.length > 1 ? [usual, factors[usual]] : widest;
  const symbolFactors = free.filter(([key]) => key !== colourKey).map(([, factor]) => factor);
  const symbols = symbolFactors.reduce(
    (/** @type {string[]} */ names, factor) =>
      names.flatMap((name) =>
        factor.names.map((level) => [name, factor.names.length > 1 ? level : ""].filter(Boolean).join(", ")),
      ),
    [""],
  );
  /** @type {Map<string, Group<R>>} */
  const byLevels = new Map();
  for (const row of rows) {
    const colour = first.of(row);
    const symbol = symbolFactors.reduce((place, factor) => place * factor.names.length + factor.of(row), 0);
    const group = byLevels.get(`${colour} ${symbol}`) ?? { colour, symbol, rows: [] };
    group.rows.push(row);
    byLevels.set(`${colour} ${symbol}`, group);
  }
  const ordered = [...byLevels.values()].sort((a, b) => a.colour - b.colour || a.symbol - b.symbol);
  return {
    groups: ordered,
    colours: first.names,
    symbols,
    colourKey,
    single: colourKey === usual ? null : (factors[usual].names[0] ?? null),
  };
}

/** @returns {Factor} */
function loads(/** @type {Condition[]} */ rows) {
  const loadLevels = levels(rows.map((row) => row.wheel_load_n));
  const { unit, scale } = shown("N");
  return {
    names: loadLevels.map((level) => levelWords(level, unit, scale)),
    of: (row) => levelOf(loadLevels, row.wheel_load_n),
  };
}

/** A rig holds the speed of the rim or that of the sled: the one with fewer levels. @returns {Factor} */
function speeds(/** @type {Condition[]} */ rows) {
  const [rim, sled] = [rimSpeed, (/** @type {Condition} */ row) => row.sled_speed_m_s].map((speed) => {
    const bounded = (/** @type {Condition} */ row) => Math.max(speed(row), LEAST_SPEED);
    return { bounded, speedLevels: levels(rows.map(bounded)) };
  });
  const [{ bounded, speedLevels }, name] =
    sled.speedLevels.length < rim.speedLevels.length ? [sled, t`sled`] : [rim, t`rim`];
  const { unit, scale } = shown("m/s");
  return {
    names: speedLevels.map((level) => `${name} ${levelWords(level, unit, scale)}`),
    of: (row) => levelOf(speedLevels, bounded(row)),
  };
}

/** @returns {Factor} */
function angles(/** @type {Condition[]} */ rows) {
  const ascending = [...new Set(rows.map((row) => row.slip_angle_deg))].sort((a, b) => a - b);
  return { names: ascending.map((angle) => `${angle}°`), of: (row) => ascending.indexOf(row.slip_angle_deg) };
}

/** A driven wheel's slips are levels; those of a wheel in skid, or near rest, are single values. @returns {Factor} */
function slips(/** @type {Condition[]} */ rows) {
  const driven = levels(rows.map((row) => row.slip).filter((slip) => slip > 0));
  const rest = [...new Set(rows.map((row) => row.slip).filter((slip) => !(slip > 0)))].sort((a, b) => a - b);
  const unit = slipUnit.unit === "1" ? "" : slipUnit.unit;
  const names = [
    ...rest.map((slip) => t`slip ${slipWords(Number(slip.toPrecision(2)))}`),
    ...driven.map((level) => t`slip ${levelWords(level, unit, slipUnit.scale)}`.trim()),
  ];
  return { names, of: (row) => (row.slip > 0 ? rest.length + levelOf(driven, row.slip) : rest.indexOf(row.slip)) };
}
