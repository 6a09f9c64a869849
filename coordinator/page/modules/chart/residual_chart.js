// Residuals of a channel against a condition, with the errors that are assumed and the tested trend.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { channelName, digits, minus, shown, titled } from "../words/quantity.js";
import { meanErrorSd } from "../words/residual.js";
import { colour, symbol } from "./colour.js";
import { spanWords } from "./condition.js";
import { Entry, Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";
import { MANY } from "./merged.js";
import { byRun, pointable } from "./runs.js";

/** The trends of the diagnosis by the axis that they run along. */
const AGAINST = /** @type {const} */ ({
  slip: "slip",
  wheel_load_n: "wheel_load",
  sled_speed_m_s: "sled_speed",
  slip_angle_deg: null,
  place: "order",
});
const LEVEL = 0.01;

/**
 * @param {{ channel: string, rows: PlacedRow[], axis: ConditionAxis<keyof typeof AGAINST>, errors: "all" | "noise",
 *   trends: Trend[], name: string }} properties
 */
export function ResidualChart({ channel, rows, axis, errors, trends, name }) {
  const isMany = rows.length > MANY;
  const judged = rows.filter((r) => r.predicted !== null && r.predicted !== undefined);
  const quantity = shown(rows[0].unit);
  const x = (/** @type {PlacedRow} */ r) => r[axis.key] * axis.scale;
  const y = (/** @type {PlacedRow} */ r) => (r.measured - (r.predicted ?? NaN)) * quantity.scale;
  const wheels = [...new Set(rows.map((r) => r.wheel))];
  const trend = trends.find((test) => test.channel === channel && test.against === AGAINST[axis.key]);
  const isBeyond = trend && trend.p * trends.length < LEVEL;
  const mean = meanErrorSd(judged, errors);
  const sd = mean === null ? null : mean * quantity.scale;
  const line = isBeyond
    ? trendLine(
        judged.filter((r) => r.use !== "holdout"),
        trend,
        x,
        y,
        quantity.scale,
      )
    : [];
  // The words are made of the run that is pointed at alone.
  const tip = (/** @type {PlacedRow} */ r) => `${t`run ${r.run}`}\n${minus(digits(y(r)))} ${quantity.unit}`;
  const draw = (/** @type {number} */ width) =>
    Plot.plot({
      width,
      height: Math.max(220, Math.min(300, 0.5 * width)),
      marginTop: 26,
      marginLeft: 56,
      marginBottom: 40,
      insetLeft: 7,
      insetRight: 7,
      grid: true,
      style: STYLE,
      x: { label: titled(axis.title, axis.unit), labelArrow: "none", labelAnchor: "center", nice: true },
      y: { label: t`measured − computed [${quantity.unit}]`, labelArrow: "none", nice: true },
      marks: [
        ...(sd === null ? [] : [Plot.rectY([0], { y1: -sd, y2: sd, fill: "currentColor", fillOpacity: 0.08 })]),
        Plot.ruleY([0], { stroke: "currentColor" }),
        Plot.lineY(line, { x: "x", y: "y", stroke: "var(--alarm)", strokeWidth: 2, className: "trend" }),
        ...wheels.flatMap((wheel, k) =>
          [false, true].map((isHeldOut) => {
            const own = judged.filter((r) => r.wheel === wheel && (r.use === "holdout") === isHeldOut);
            return Plot.dot(
              own,
              byRun(
                own,
                {
                  x,
                  y,
                  r: 3.6,
                  symbol: symbol(k),
                  ...(isHeldOut ? { stroke: colour(k), fill: "var(--paper)", strokeWidth: 1.6 } : { fill: colour(k) }),
                },
                isMany,
              ),
            );
          }),
        ),
        Plot.tip(
          judged,
          Plot.pointer({
            x,
            y,
            title: (/** @type {PlacedRow} */ r) => r,
            format: { title: tip },
            maxRadius: 12,
            fill: "var(--panel)",
            stroke: "var(--rule)",
          }),
        ),
      ],
    });
  const runsIn = (/** @type {number} */ from, /** @type {number} */ to) =>
    judged.filter((r) => x(r) >= from && x(r) <= to).map((r) => r.run);
  const note = isBeyond
    ? t`trend: ${minus(digits(trend.change * quantity.scale))} ${quantity.unit} from one end to the other, before the
      fit compensates`
    : trend
      ? t`no trend of the fitted runs beyond chance`
      : "";
  return html`
    <${Figure}
      title=${t`Residuals of ${channelName(channel)} against ${axis.title}`}
      note=${note}
      name=${fileName(name, "residuals", channel, axis.short)}
      deps=${[rows, axis.key, errors, trend]}
      draw=${draw}
      rows=${() =>
        judged.map((r) => ({
          run: r.run,
          use: r.use,
          wheel: r.wheel,
          [axis.key]: r[axis.key],
          [`residual [${quantity.unit}]`]: y(r),
        }))}
      onDrawn=${(/** @type {Picture} */ plot) =>
        pointable(plot, { runsIn, words: (from, to) => spanWords(axis, from, to) })}
      legend=${html`
        ${
          wheels.length > 1 &&
          wheels.map(
            (wheel, k) => html`<span><i class="swatch" style=${{ background: colour(k) }}></i>wheel ${wheel}</span>`,
          )
        }
        ${
          judged.some((r) => r.use === "holdout") &&
          html`
            <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="none" stroke="currentColor" stroke-width="2" />`}>
              held out
            <//>
          `
        }
      `}
    />
  `;
}

/** The trend as it is left in the residuals: a straight line through their middle. */
function trendLine(
  /** @type {PlacedRow[]} */ rows,
  /** @type {Trend} */ trend,
  /** @type {(r: PlacedRow) => number} */ x,
  /** @type {(r: PlacedRow) => number} */ y,
  /** @type {number} */ scale,
) {
  const places = rows.map(x);
  const [low, high] = [Math.min(...places), Math.max(...places)];
  const mean = (/** @type {number[]} */ values) => values.reduce((a, b) => a + b, 0) / values.length;
  const slope = (trend.change * (trend.share_left ?? 1) * scale) / (high - low);
  const [centre, level] = [mean(places), mean(rows.map(y))];
  return [low, high].map((at) => ({ x: at, y: level + slope * (at - centre) }));
}
