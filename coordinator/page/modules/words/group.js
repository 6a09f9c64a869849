// Runs of like conditions: what belongs on one line of a picture.

import { t } from "../language/language.js";
import { slipUnit } from "../units.js";
import { slipWords } from "./condition.js";
import { levelOf, levels, levelWords } from "./level.js";
import { shown } from "./quantity.js";

/** A wheel at rest has no ratio to others [m/s]. */
const LEAST_SPEED = 1e-9;

/** @typedef {{ run: string, wheel: string, slip: number, wheel_load_n: number, sled_speed_m_s: number, slip_angle_deg: number }} Condition */

/** The speed of the rim [m/s], from slip and sled speed. */
export function rimSpeed(/** @type {Condition} */ { slip, sled_speed_m_s }) {
  return slip >= 0 ? sled_speed_m_s / (1 - slip) : sled_speed_m_s * (1 + slip);
}

/**
 * @template {Condition} R
 * @typedef {{ colour: number, symbol: number, rows: R[] }} Group
 */

/** @typedef {{ names: string[], of: (row: any) => number }} Factor the levels of a condition by name, and the place of a row among them */

/**
 * Groups rows whose conditions are equal but for one, against which they are drawn. The colour of a group is its wheel load, or its slip
 * where runs are drawn against the load, or the condition with most levels where that one has a single level; its symbol tells the other
 * conditions that were set to several levels.
 * @template {Condition} R
 * @param {R[]} rows
 * @param {string} against key of the condition that a group goes through
 * @returns {{ groups: Group<R>[], colours: string[], symbols: string[], colourKey: string, single: string | null }} groups in the order of
 *   their levels, with the names of these; colourKey: the condition that colours tell; single: the one level of the usual one, if it has one
 */
export function groups(rows, against = "slip") {
  const factors = { slip: slips(rows), wheel_load_n: loads(rows), sled_speed_m_s: speeds(rows), slip_angle_deg: angles(rows) };
  const usual = against === "wheel_load_n" ? "slip" : "wheel_load_n";
  const free = Object.entries(factors).filter(([key]) => key !== against);
  const widest = free.reduce((most, one) => (one[1].names.length > most[1].names.length ? one : most), [usual, factors[usual]]);
  const [colourKey, first] = factors[usual].names.length > 1 ? [usual, factors[usual]] : widest;
  const others = free.filter(([key]) => key !== colourKey).map(([, factor]) => factor);
  const symbols = others.reduce((/** @type {string[]} */ names, factor) =>
    names.flatMap((name) => factor.names.map((level) => [name, factor.names.length > 1 ? level : ""].filter(Boolean).join(", "))), [""]);
  /** @type {Map<string, Group<R>>} */
  const found = new Map();
  for (const row of rows) {
    const colour = first.of(row);
    const symbol = others.reduce((place, factor) => place * factor.names.length + factor.of(row), 0);
    const group = found.get(`${colour} ${symbol}`) ?? { colour, symbol, rows: [] };
    group.rows.push(row);
    found.set(`${colour} ${symbol}`, group);
  }
  const ordered = [...found.values()].sort((a, b) => a.colour - b.colour || a.symbol - b.symbol);
  return { groups: ordered, colours: first.names, symbols, colourKey, single: colourKey === usual ? null : factors[usual].names[0] ?? null };
}

/** @returns {Factor} */
function loads(/** @type {Condition[]} */ rows) {
  const found = levels(rows.map((row) => row.wheel_load_n));
  return { names: found.map((level) => levelWords(level, shown("N").unit, shown("N").scale)), of: (row) => levelOf(found, row.wheel_load_n) };
}

/** A rig holds the speed of the rim or that of the sled: the one with fewer levels. @returns {Factor} */
function speeds(/** @type {Condition[]} */ rows) {
  const [rim, sled] = [rimSpeed, (/** @type {Condition} */ row) => row.sled_speed_m_s].map((speed) => {
    const own = (/** @type {Condition} */ row) => Math.max(speed(row), LEAST_SPEED);
    return { own, found: levels(rows.map(own)) };
  });
  const [{ own, found }, held] = sled.found.length < rim.found.length ? [sled, t`sled`] : [rim, t`rim`];
  return { names: found.map((level) => `${held} ${levelWords(level, shown("m/s").unit, shown("m/s").scale)}`), of: (row) => levelOf(found, own(row)) };
}

/** @returns {Factor} */
function angles(/** @type {Condition[]} */ rows) {
  const found = [...new Set(rows.map((row) => row.slip_angle_deg))].sort((a, b) => a - b);
  return { names: found.map((angle) => `${angle}°`), of: (row) => found.indexOf(row.slip_angle_deg) };
}

/** A driven wheel's slips are levels; those of a wheel in skid, or near rest, are single values. @returns {Factor} */
function slips(/** @type {Condition[]} */ rows) {
  const driven = levels(rows.map((row) => row.slip).filter((slip) => slip > 0));
  const rest = [...new Set(rows.map((row) => row.slip).filter((slip) => !(slip > 0)))].sort((a, b) => a - b);
  const names = [...rest.map((slip) => t`slip ${slipWords(Number(slip.toPrecision(2)))}`), ...driven.map((level) => t`slip ${levelWords(level, slipUnit.unit === "1" ? "" : slipUnit.unit, slipUnit.scale)}`.trim())];
  return { names, of: (row) => (row.slip > 0 ? rest.length + levelOf(driven, row.slip) : rest.indexOf(row.slip)) };
}
