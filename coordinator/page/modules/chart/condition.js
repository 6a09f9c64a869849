// The conditions that runs are drawn against.

/** @typedef {{ key: string, title: string, short: string, unit: string, scale: number }} ConditionAxis */

/** @type {ConditionAxis[]} */
export const CONDITIONS = [
  { key: "slip", title: "slip", short: "slip", unit: "1", scale: 1 },
  { key: "wheel_load_n", title: "wheel load", short: "load", unit: "N", scale: 1 },
  { key: "sled_speed_m_s", title: "sled speed", short: "speed", unit: "mm/s", scale: 1000 },
  { key: "slip_angle_deg", title: "slip angle", short: "angle", unit: "°", scale: 1 },
];

/** The conditions that vary among rows; slip always stands among them. */
export function varying(/** @type {any[]} */ rows) {
  return CONDITIONS.filter(({ key }) => key === "slip" || new Set(rows.map((row) => row[key])).size > 1);
}

/** `slip 0.05 to 0.2`. */
export function spanWords(/** @type {ConditionAxis} */ axis, /** @type {number} */ from, /** @type {number} */ to) {
  const text = (/** @type {number} */ v) => String(Number(v.toPrecision(2))).replace("-", "−");
  return `${axis.short} ${text(from)} to ${text(to)}${axis.unit === "1" ? "" : ` ${axis.unit}`}`;
}
