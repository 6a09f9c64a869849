// What a prediction gives, as words: the channels, and what follows from them.

import { t } from "../language/language.js";
import { channelName, shown, words } from "./quantity.js";

const CHANNELS = /** @type {Record<string, string>} */ ({
  drawbar_pull_n: "drawbar_pull",
  torque_n_m: "torque",
  sinkage_m: "sinkage",
  lateral_force_n: "lateral_force",
});
const DERIVED = /** @type {Record<string, string>} */ ({
  traction_coefficient: t`pull over load`,
  power_number: t`power number`,
  tractive_efficiency: t`tractive efficiency`,
  balanced_slope_deg: t`slope that the pull balances`,
  energy_j_m: t`energy for a metre`,
});
/** What a condition states already, or what only a slope has. */
const HIDDEN = [
  "slip",
  "wheel_load_n",
  "sled_speed_m_s",
  "slip_angle_deg",
  "gravity_m_s2",
  "slope_deg",
  "stuck",
  "net_pull_n",
];

/** @typedef {{ name: string, unit: string }} Quantity unit: in SI */

/** The quantities of a predicted run, or of a grid, that are shown. @returns {Quantity[]} */
export const shownQuantities = (/** @type {{ quantities: Quantity[] }} */ { quantities }) =>
  quantities.filter(({ name }) => !HIDDEN.includes(name)).map(({ name, unit }) => ({ name, unit }));

/** The name of a quantity as words, without its unit. */
export const quantityName = (/** @type {string} */ name) =>
  CHANNELS[name] ? channelName(CHANNELS[name]) : (DERIVED[name] ?? words(name));

/** What the interval of a prediction is. */
export const intervalName = (/** @type {boolean} */ isMeasurement) =>
  isMeasurement ? t`90 % of new measurements` : t`90 % by the parameters alone: the noise is not known`;

/** The channel that a quantity is; null of what follows from channels. */
export const channelOf = (/** @type {string} */ name) => CHANNELS[name] ?? null;

/**
 * The quantities that a campaign measured, and those that follow from channels.
 * @param {Quantity[]} quantities
 * @param {{ channel: string }[]} rows of a comparison
 */
export const measuredQuantities = (quantities, rows) =>
  quantities.filter(({ name }) => channelOf(name) === null || rows.some(({ channel }) => channel === channelOf(name)));

/**
 * A statement as the service reads it, in SI; null where it is not complete.
 * @param {Quantity | undefined} quantity
 * @param {string} sign
 * @param {number | null} limit in the unit that is shown
 */
export const statementOf = (quantity, sign, limit) =>
  limit === null || !quantity ? null : `${quantity.name} ${sign} ${limit / shown(quantity.unit).scale}`;
