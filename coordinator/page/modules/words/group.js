// Runs of like conditions: what belongs on one line of a picture.

/** A greater ratio of neighbouring values begins another level. */
const GAP = 1.15;
/** A wheel at rest has no ratio to others [m/s]. */
const LEAST_SPEED = 1e-9;

/** @typedef {{ run: string, wheel: string, slip: number, wheel_load_n: number, sled_speed_m_s: number, slip_angle_deg: number }} Condition */

/** The speed of the rim [m/s], from slip and sled speed. */
export function rimSpeed(/** @type {Condition} */ { slip, sled_speed_m_s }) {
  return slip >= 0 ? sled_speed_m_s / (1 - slip) : sled_speed_m_s * (1 + slip);
}

/**
 * Levels of a positive quantity: ranges that lie more than 15 % apart, ascending.
 * @param {number[]} values
 * @returns {{ low: number, high: number }[]}
 */
export function levels(values) {
  const ascending = [...values].sort((a, b) => a - b);
  /** @type {{ low: number, high: number }[]} */
  const found = [];
  for (const value of ascending) {
    const last = found.at(-1);
    if (last && value <= last.high * GAP) last.high = value;
    else found.push({ low: value, high: value });
  }
  return found;
}

/** The place of a value among levels. */
export const levelOf = (/** @type {{ low: number, high: number }[]} */ all, /** @type {number} */ value) =>
  all.findIndex(({ low, high }) => value >= low && value <= high);

/** `60 N`, `21 to 27 N`. */
export function levelWords(/** @type {{ low: number, high: number }} */ { low, high }, /** @type {string} */ unit, scale = 1) {
  const [from, to] = [low, high].map((v) => String(Number((v * scale).toPrecision(2))));
  return from === to ? `${from} ${unit}` : `${from} to ${to} ${unit}`;
}

/**
 * @template {Condition} R
 * @typedef {{ load: number, other: number, rows: R[] }} Group
 */

/**
 * Groups rows by wheel load, and by speed and slip angle where these were set to several levels. A rig holds the speed of the rim or
 * that of the sled: the one with fewer levels.
 * @template {Condition} R
 * @param {R[]} rows
 * @returns {{ groups: Group<R>[], loads: string[], others: string[] }} groups by rising load, then speed, then angle, with the places of
 *   their names among the loads and the others
 */
export function groups(rows) {
  const loads = levels(rows.map((row) => row.wheel_load_n));
  const [ofRim, ofSled] = [rimSpeed, (/** @type {Condition} */ row) => row.sled_speed_m_s].map((of) => levels(rows.map((row) => Math.max(of(row), LEAST_SPEED))));
  const isSled = ofSled.length < ofRim.length;
  const [speeds, held] = isSled ? [ofSled, "sled"] : [ofRim, "rim"];
  const speed = (/** @type {R} */ row) => Math.max(isSled ? row.sled_speed_m_s : rimSpeed(row), LEAST_SPEED);
  const angles = [...new Set(rows.map((row) => row.slip_angle_deg))].sort((a, b) => a - b);
  const others = speeds.flatMap((level) => angles.map((angle) => [
    speeds.length > 1 ? `${held} ${levelWords(level, "mm/s", 1000)}` : "",
    angles.length > 1 ? `${angle}°` : "",
  ].filter(Boolean).join(", ")));
  /** @type {Map<string, Group<R>>} */
  const found = new Map();
  for (const row of rows) {
    const load = levelOf(loads, row.wheel_load_n);
    const other = levelOf(speeds, speed(row)) * angles.length + angles.indexOf(row.slip_angle_deg);
    const key = `${load} ${other}`;
    const group = found.get(key) ?? { load, other, rows: [] };
    group.rows.push(row);
    found.set(key, group);
  }
  const ordered = [...found.values()].sort((a, b) => a.load - b.load || a.other - b.other);
  return { groups: ordered, loads: loads.map((level) => levelWords(level, "N")), others };
}
