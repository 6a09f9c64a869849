// The error ledger of each channel: fitted and held-out error by model, with the noise floor and what interpolation
// reaches.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { changesOfRuns, dataSets, step } from "../words/ledger.js";
import { channelName, CHANNELS, digits, errorWords, shown, titled, unitOf } from "../words/quantity.js";
import { Entry, Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";
import { PADDING, tickLabels } from "./tick_labels.js";

/** Values stand beside their points where these are so far apart [px]; the table below has them all. */
const LEAST_STEP = 40;
const RIGHT = 30;
/** A straight line of a length. */
const DASH = {
  draw: (/** @type {CanvasPath} */ context, /** @type {number} */ length) => {
    context.moveTo(0, 0);
    context.lineTo(0, -length);
  },
};

/** @typedef {import("../words/ledger.js").LedgerLine & { colour: string }} LedgerLine */

/** @param {{ study: Study, lines: LedgerLine[] }} properties */
export function LedgerCharts({ study, lines }) {
  const channels = CHANNELS.filter((channel) => lines.some(({ line }) => line.error.fit?.[channel]));
  return html`
    ${
      dataSets(lines).length > 1 &&
      html`<p class="note">A line breaks where the runs changed: errors over different runs do not compare.</p>`
    }
    <div class="figures small">
      ${channels.map(
        (channel) => html`<${LedgerChart} key=${channel} study=${study} lines=${lines} channel=${channel} />`,
      )}
    </div>
  `;
}

// The colour of a point is that of its model in every picture; its filling tells the use of the runs.
const LOOKS = /** @type {const} */ ([
  { use: "fit", words: t`fitted`, dash: "" },
  { use: "holdout", words: t`held out`, dash: "3 3" },
]);

/**
 * @typedef {{ name: string, look: (typeof LOOKS)[number], colour: string, part: number, rmse: number, runs: number }}
 *   ErrorPoint
 */

function LedgerChart(/** @type {{ study: Study, lines: LedgerLine[], channel: Channel }} */ { study, lines, channel }) {
  const quantity = shown(unitOf(channel));
  const changes = changesOfRuns(lines);
  const points = lines.flatMap(({ name, line, colour }, k) =>
    LOOKS.flatMap((look) => {
      const error = line.error[look.use]?.[channel];
      return error
        ? [{ name, look, colour, part: changes[k], rmse: error.rmse * quantity.scale, runs: error.runs }]
        : [];
    }),
  );
  const sigma = study.fixed_sigma[channel];
  const floor = sigma ? sigma.sd * quantity.scale : null;
  const baseline = lines.flatMap(({ name, line }) => {
    const rmse = line.baseline.holdout?.[channel]?.rmse;
    return rmse === undefined ? [] : [{ name, rmse: rmse * quantity.scale }];
  });
  const draw = (/** @type {number} */ width) =>
    picture({
      width,
      lines,
      points,
      floor,
      baseline,
      title: titled(t`error of ${channelName(channel)}`, quantity.unit),
    });
  const reached = [...new Set(baseline.map(({ rmse }) => errorWords(rmse)))];
  return html`
    <${Figure}
      title=${t`Error of ${channelName(channel)}`}
      name=${fileName(study.name, "error", channel)}
      deps=${[lines.length, points.map((p) => p.rmse).join()]}
      draw=${draw}
      rows=${() =>
        points.map((p) => ({ model: p.name, runs: p.look.words, [`rmse [${quantity.unit}]`]: p.rmse, number: p.runs }))}
      legend=${html`
        <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="currentColor" />`}>fitted<//>
        ${
          points.some((p) => p.look.use === "holdout") &&
          html`
            <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="none" stroke="currentColor" stroke-width="2" />`}>
              held out
            <//>
          `
        }
        ${
          floor !== null &&
          html`
            <${Entry} glyph=${html`<path d="M0 8h16" stroke="var(--soft)" stroke-dasharray="2 3" />`}>
              noise ${digits(floor, 2)} ${quantity.unit}
            <//>
          `
        }
        ${
          reached.length > 0 &&
          html`
            <${Entry} glyph=${html`<path d="M0 8h16" stroke="var(--prior)" stroke-dasharray="7 4" stroke-width="2" />`}>
              interpolation and extrapolation, held out: ${reached.join(t`, then `)} ${quantity.unit}
            <//>
          `
        }
      `}
    />
  `;
}

/**
 * @param {{ width: number, lines: LedgerLine[], points: ErrorPoint[], floor: number | null, baseline: { name: string,
 *   rmse: number }[], title: string }} properties
 */
function picture({ width, lines, points, floor, baseline, title }) {
  const names = lines.map((l) => l.name);
  const labels = tickLabels({ names: lines.map((line, k) => step(lines[k - 1], line)), width, left: 56, right: RIGHT });
  // The greater error of a model has its value above, the lesser below.
  const isUpper = (/** @type {ErrorPoint} */ p) =>
    points.every(
      (other) =>
        other.name !== p.name ||
        other === p ||
        other.rmse < p.rmse ||
        (other.rmse === p.rmse && other.look.use === "fit"),
    );
  const value = (/** @type {ErrorPoint[]} */ some, /** @type {number} */ dy) =>
    Plot.text(some, {
      x: "name",
      y: "rmse",
      dy,
      text: (/** @type {ErrorPoint} */ p) => (labels.step < 1.5 * LEAST_STEP ? digits(p.rmse, 2) : errorWords(p.rmse)),
      fill: "currentColor",
      stroke: "var(--paper)",
      strokeWidth: 5,
    });
  const values =
    labels.step < LEAST_STEP
      ? []
      : [
          value(points.filter(isUpper), -14),
          value(
            points.filter((p) => !isUpper(p)),
            15,
          ),
        ];
  return Plot.plot({
    width,
    height: 190 + labels.bottom,
    marginLeft: labels.left,
    marginBottom: labels.bottom,
    marginRight: RIGHT,
    marginTop: 28,
    insetTop: 18,
    insetBottom: 20,
    style: STYLE,
    x: {
      type: "point",
      domain: names,
      label: null,
      tickFormat: (/** @type {string} */ n) => labels.texts[names.indexOf(n)],
      tickRotate: labels.rotate,
      tickSize: 3,
      padding: PADDING,
    },
    y: { label: title, labelArrow: "none", zero: true, nice: true, grid: true },
    color: { type: "identity" },
    marks: [
      ...(floor === null ? [] : [Plot.ruleY([floor], { stroke: "var(--soft)", strokeDasharray: "2 3" })]),
      // A rule spans the whole picture: this line is as wide as the step of its model.
      Plot.vector(baseline, {
        x: "name",
        y: "rmse",
        rotate: 90,
        anchor: "middle",
        length: labels.step,
        shape: DASH,
        stroke: "var(--prior)",
        strokeWidth: 1.5,
        strokeDasharray: "7 4",
        className: "interpolation",
      }),
      Plot.ruleY([0]),
      // Lines first: none strikes through a point or a value. Each ends where the runs change.
      ...LOOKS.map((look) =>
        Plot.lineY(
          points.filter((p) => p.look === look),
          {
            x: "name",
            y: "rmse",
            z: "part",
            stroke: "var(--soft)",
            strokeDasharray: look.dash,
            strokeWidth: 1.4,
            className: "errors",
          },
        ),
      ),
      ...LOOKS.map((look) =>
        Plot.dot(
          points.filter((p) => p.look === look),
          {
            x: "name",
            y: "rmse",
            r: 4.5,
            stroke: "colour",
            fill: look.use === "fit" ? "colour" : "var(--paper)",
            strokeWidth: 1.8,
          },
        ),
      ),
      ...values,
    ],
  });
}
