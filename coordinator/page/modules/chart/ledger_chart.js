// The error ledger of each channel: fitted and held-out error by model, with the noise floor and what interpolation reaches.

import { html } from "../html.js";
import { CHANNELS, digits, shown, titled, unitOf, words } from "../words/quantity.js";
import { Entry, Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";

/** @param {{ study: any, lines: any[] }} properties */
export function LedgerCharts({ study, lines }) {
  const channels = CHANNELS.filter((channel) => lines.some(({ line }) => line.error.fit[channel]));
  return html`<div class="figures small">${channels.map((channel) => html`<${LedgerChart} key=${channel} study=${study} lines=${lines} channel=${channel} />`)}</div>`;
}

function LedgerChart(/** @type {{ study: any, lines: any[], channel: string }} */ { study, lines, channel }) {
  const quantity = shown(unitOf(channel));
  const points = lines.flatMap(({ name, line }) => ["fit", "holdout"].flatMap((use) => {
    const error = line.error[use]?.[channel];
    return error ? [{ name, use: use === "fit" ? "fitted" : "held out", rmse: error.rmse * quantity.scale, runs: error.runs }] : [];
  }));
  const sigma = study.fixed_sigma?.[channel];
  const floor = sigma ? (sigma.sd ?? sigma) * quantity.scale : null;
  const baseline = lines.map(({ line }) => line.baseline?.holdout?.[channel]?.rmse).find((v) => v !== undefined && v !== null);
  const names = lines.map((l) => l.name);
  const isLong = names.length > MOST_WRAPPED;
  const draw = (/** @type {number} */ width) => Plot.plot({
    width, height: isLong ? 330 : 260, marginLeft: isLong ? 90 : 56, marginBottom: isLong ? 130 : 60, marginRight: 40, marginTop: 28, insetTop: 8, insetBottom: isLong ? 18 : 0, style: STYLE,
    x: { type: "point", domain: names, label: null, tickFormat: (/** @type {string} */ n) => (isLong ? step(names, n) : wrap(n)), tickRotate: isLong ? -40 : 0, tickSize: 3, padding: 0.7 },
    y: { label: titled(`error of ${words(channel)}`, quantity.unit), labelArrow: "none", zero: true, nice: true, grid: true },
    marks: [
      ...(floor === null ? [] : [Plot.ruleY([floor], { stroke: "var(--soft)", strokeDasharray: "2 3" })]),
      ...(baseline === undefined ? [] : [Plot.ruleY([baseline * quantity.scale], { stroke: "var(--prior)", strokeDasharray: "7 4" })]),
      Plot.ruleY([0]),
      ...["fitted", "held out"].flatMap((use, k) => {
        const own = points.filter((p) => p.use === use);
        const look = { stroke: k === 0 ? "var(--series-0)" : "var(--series-1)" };
        return [
          Plot.lineY(own, { x: "name", y: "rmse", ...look, strokeWidth: 1.8 }),
          Plot.dot(own, { x: "name", y: "rmse", r: 4.5, ...look, fill: k === 0 ? "var(--series-0)" : "var(--paper)", strokeWidth: 1.8 }),
          Plot.text(own, { x: "name", y: "rmse", text: (/** @type {any} */ p) => digits(p.rmse, isLong ? 2 : undefined), ...(isLong ? { dy: k === 0 ? 14 : -13 } : { textAnchor: k === 0 ? "end" : "start", dx: k === 0 ? -9 : 9 }), fill: "currentColor", stroke: "var(--paper)", strokeWidth: 4 }),
        ];
      }),
    ],
  });
  return html`<${Figure} title=${`Error of ${words(channel)}`} name=${fileName(study.name, "error", channel)} deps=${[lines.length, points.map((p) => p.rmse).join()]} draw=${draw}
    rows=${() => points.map((p) => ({ model: p.name, runs: p.use, [`rmse [${quantity.unit}]`]: p.rmse, number: p.runs }))}
    legend=${html`
      <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="var(--series-0)" />`}>fitted<//>
      ${points.some((p) => p.use === "held out") && html`<${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="none" stroke="var(--series-1)" stroke-width="2" />`}>held out<//>`}
      ${floor !== null && html`<${Entry} glyph=${html`<path d="M0 8h16" stroke="var(--soft)" stroke-dasharray="2 3" />`}>noise ${digits(floor, 2)} ${quantity.unit}<//>`}
      ${baseline !== undefined && html`<${Entry} glyph=${html`<path d="M0 8h16" stroke="var(--prior)" stroke-dasharray="7 4" stroke-width="2" />`}>interpolation, held out: ${digits(baseline * quantity.scale)} ${quantity.unit}<//>`}`} />`;
}

/** More models than this have no room for their whole names. */
const MOST_WRAPPED = 4;

/** What a model has that the one before it has not. */
function step(/** @type {string[]} */ names, /** @type {string} */ name) {
  const parts = (/** @type {string | undefined} */ own) => (own ?? "").replace(/^with /, "").split(", ");
  const before = parts(names[names.indexOf(name) - 1]);
  const added = parts(name).filter((part) => !before.includes(part));
  return names[0] === name || added.length === 0 ? name : added.map((part) => `+ ${part}`).join(", ");
}

/** A name on lines of some twelve characters. */
const wrap = (/** @type {string} */ name) => name.replace(/, /g, ",\n").replace(/^with /, "with\n");
