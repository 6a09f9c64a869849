// The conditions that runs are drawn against.

import { t } from "../language/language.js";
import { slipUnit } from "../units.js";
import { minus, shown } from "../words/quantity.js";

/** @type {ConditionAxis[]} */
export const CONDITIONS = [
  { key: "slip", title: t`slip`, short: t`slip`, ...slipUnit },
  { key: "wheel_load_n", title: t`wheel load`, short: t`load`, ...shown("N") },
  { key: "sled_speed_m_s", title: t`sled speed`, short: t`speed`, ...shown("m/s") },
  { key: "slip_angle_deg", title: t`slip angle`, short: t`angle`, unit: "°", scale: 1 },
];

/** The conditions that vary among rows; slip always stands among them. */
export function varying(/** @type {MeasuredRow[]} */ rows) {
  return CONDITIONS.filter(({ key }) => key === "slip" || new Set(rows.map((row) => row[key])).size > 1);
}

/** `slip 0.05 to 0.2`. */
export function spanWords(
  /** @type {Pick<ConditionAxis, "short" | "unit">} */ axis,
  /** @type {number} */ from,
  /** @type {number} */ to,
) {
  const text = (/** @type {number} */ v) => minus(Number(v.toPrecision(3)));
  return `${axis.short} ${text(from)}${t` to `}${text(to)}${axis.unit === "1" ? "" : ` ${axis.unit}`}`;
}
