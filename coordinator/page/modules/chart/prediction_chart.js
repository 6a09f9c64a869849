// A predicted quantity over slip: the curve with its band, the chosen slip, and the runs that were measured near the
// chosen condition.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { slipUnit } from "../units.js";
import { digits, shown, titled } from "../words/quantity.js";
import { intervalName, quantityName } from "../words/predicted_quantity.js";
import { Entry, Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";

/** @typedef {import("../prediction_table.js").Spread & { slip: number }} SpreadAtSlip */

/**
 * @param {{ quantity: { name: string, unit: string }, points: SpreadAtSlip[], here: SpreadAtSlip | null, fitted:
 *   [number, number], measured: MeasuredRow[], name: string }} properties fitted: the slips of the fitted runs.
 *   measured: rows of a comparison
 */
export function PredictionChart({ quantity, points, here, fitted, measured, name }) {
  const { unit, scale } = shown(quantity.unit);
  const x = (/** @type {{ slip: number }} */ row) => row.slip * slipUnit.scale;
  const y = (/** @type {"mean" | "low" | "high"} */ key) => (/** @type {SpreadAtSlip} */ row) => row[key] * scale;
  const title = t`Predicted ${quantityName(quantity.name)} by slip`;
  const beyond = [
    [points[0]?.slip, fitted[0]],
    [fitted[1], points.at(-1)?.slip],
  ].filter(([from, to]) => from !== undefined && to !== undefined && from < to);
  const curve = { x, curve: /** @type {const} */ ("monotone-x") };
  const draw = (/** @type {number} */ width) =>
    Plot.plot({
      width,
      height: Math.max(240, Math.min(420, 0.55 * width)),
      marginTop: 26,
      marginLeft: 60,
      marginBottom: 40,
      inset: 6,
      grid: true,
      style: STYLE,
      x: { label: titled(t`slip`, slipUnit.unit), labelArrow: "none", labelAnchor: "center" },
      y: { label: titled(quantityName(quantity.name), unit), labelArrow: "none", nice: true },
      marks: [
        Plot.rectX(beyond, {
          x1: (/** @type {[number, number]} */ d) => d[0] * slipUnit.scale,
          x2: (/** @type {[number, number]} */ d) => d[1] * slipUnit.scale,
          fill: "var(--rule)",
          fillOpacity: 0.35,
        }),
        Plot.areaY(points, { ...curve, y1: y("low"), y2: y("high"), fill: "var(--series-0)", fillOpacity: 0.18 }),
        Plot.lineY(points, { ...curve, y: y("mean"), stroke: "var(--series-0)", strokeWidth: 2 }),
        Plot.dot(measured, {
          x,
          y: (/** @type {MeasuredRow} */ row) => row.measured * scale,
          r: 4.2,
          fill: (/** @type {MeasuredRow} */ row) => (row.use === "holdout" ? "var(--paper)" : "var(--measured)"),
          stroke: "var(--measured)",
        }),
        ...(here
          ? [
              Plot.ruleX([here], { x, y1: y("low"), y2: y("high"), stroke: "var(--series-1)", strokeWidth: 2.5 }),
              Plot.dot([here], {
                x,
                y: y("mean"),
                r: 6,
                symbol: "diamond",
                fill: "var(--series-1)",
                stroke: "var(--paper)",
              }),
            ]
          : []),
      ],
    });
  const rows = () =>
    points.map((point) => ({
      slip: point.slip,
      quantity: quantity.name,
      unit: quantity.unit,
      mean: point.mean,
      low: point.low,
      high: point.high,
      interval: point.isMeasurement ? "measurement" : "parameters",
    }));
  return html`
    <${Figure}
      title=${title}
      name=${fileName(name, quantity.name, "predicted")}
      deps=${[points, here, measured, quantity.name]}
      draw=${draw}
      rows=${rows}
      legend=${html`
        <${Entry} glyph=${html`<rect y="5" width="16" height="6" fill="var(--series-0)" opacity=".4" />`}>
          ${intervalName(points.every((point) => point.isMeasurement))}
        <//>
        ${
          here &&
          html`
            <${Entry} glyph=${html`<path d="M8 1 15 8 8 15 1 8Z" fill="var(--series-1)" />`}>
              ${t`chosen slip: ${digits(here.mean * scale)} ${unit === "1" ? "" : unit}`}
            <//>
          `
        }
        ${
          measured.length > 0 &&
          html`
            <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="var(--measured)" />`}>
              measured near this condition
            <//>
          `
        }
        ${
          measured.some((row) => row.use === "holdout") &&
          html`
            <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="none" stroke="var(--measured)" />`}>held out<//>
          `
        }
        ${
          beyond.length > 0 &&
          html`
            <${Entry} glyph=${html`<rect y="2" width="16" height="12" fill="var(--rule)" opacity=".6" />`}>
              beyond the fitted slips
            <//>
          `
        }
      `}
    />
  `;
}
