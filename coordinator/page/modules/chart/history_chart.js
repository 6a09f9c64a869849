// Measurement and model over time, with the window that is averaged (the source paper's Fig. 7).

import { html } from "../html.js";
import { t, translated } from "../language/language.js";
import { channelName, shown, titled } from "../words/quantity.js";
import { colour } from "./colour.js";
import { Entry, Figure, fileName } from "./figure.js";
import { residuals } from "./history_residuals.js";
import { Plot, STYLE } from "./library.js";

/** @param {{ history: ChannelHistory, name: string }} properties one channel of one run, with its residuals below */
export function HistoryCharts({ history, name }) {
  return html`
    <div>
      <${HistoryChart} history=${history} name=${name} />
      ${history.measured && html`<${ResidualChart} history=${history} name=${name} />`}
    </div>
  `;
}

/** @param {{ history: ChannelHistory, name: string }} properties */
function HistoryChart({ history, name }) {
  const quantity = shown(history.unit);
  const points = (/** @type {{ t_s: number[], value: number[] }} */ series) =>
    series.t_s.map((t, k) => ({ t, value: series.value[k] * quantity.scale }));
  const lines = [
    ...(history.measured ? [{ name: t`measured`, stroke: "var(--measured)", points: points(history.measured) }] : []),
    ...history.model.map((m, k) => ({
      name: translated(m.label),
      stroke: colour(k),
      points: points(m),
    })),
  ];
  const windows = history.measured ? [history.measured.window_s] : [];
  const draw = (/** @type {number} */ width) =>
    Plot.plot({
      width,
      height: 240,
      marginLeft: 56,
      marginBottom: 40,
      grid: true,
      style: STYLE,
      x: { label: t`time [s]`, labelArrow: "none", labelAnchor: "center" },
      y: { label: titled(channelName(history.channel), quantity.unit), labelArrow: "none", nice: true },
      marks: [
        ...windows.map(([from, to]) => Plot.rectY([0], { x1: from, x2: to, fill: "currentColor", fillOpacity: 0.06 })),
        ...lines.map((line) => Plot.lineY(line.points, { x: "t", y: "value", stroke: line.stroke, strokeWidth: 1.3 })),
      ],
    });
  const rows = () =>
    lines.flatMap((line) =>
      line.points.map((p) => ({
        series: line.name,
        t_s: p.t,
        [`${history.channel} [${quantity.unit}]`]: p.value,
      })),
    );
  return html`
    <${Figure}
      title=${t`${channelName(history.channel)} of run ${history.run} over time`}
      name=${fileName(name, "history", history.run, history.channel)}
      deps=${[history]}
      draw=${draw}
      rows=${rows}
      legend=${lines.map(
        (line) =>
          html`<${Entry} glyph=${html`<path d="M0 8h16" stroke=${line.stroke} stroke-width="2" />`}>${line.name}<//>`,
      )}
    />
  `;
}

/** @param {{ history: ChannelHistory, name: string }} properties a history that is measured */
function ResidualChart({ history, name }) {
  const quantity = shown(history.unit);
  const lines = history.model.map((m, k) => ({
    name: translated(m.label),
    stroke: colour(k),
    points: residuals(history, m).map(({ t, value }) => ({ t, value: value * quantity.scale })),
  }));
  const draw = (/** @type {number} */ width) =>
    Plot.plot({
      width,
      height: 120,
      marginLeft: 56,
      marginBottom: 40,
      grid: true,
      style: STYLE,
      x: { label: t`time [s]`, labelArrow: "none", labelAnchor: "center", domain: duration(history) },
      y: { label: t`measured − model [${quantity.unit}]`, labelArrow: "none", nice: true, ticks: 4 },
      marks: [
        Plot.ruleY([0]),
        ...lines.map((line) => Plot.lineY(line.points, { x: "t", y: "value", stroke: line.stroke, strokeWidth: 1.3 })),
      ],
    });
  const rows = () =>
    lines.flatMap((line) =>
      line.points.map((p) => ({ series: line.name, t_s: p.t, [`residual [${quantity.unit}]`]: p.value })),
    );
  return html`
    <${Figure}
      title=${t`residuals of ${channelName(history.channel)} of run ${history.run} over time`}
      name=${fileName(name, "residual", history.run, history.channel)}
      deps=${[history]}
      draw=${draw}
      rows=${rows}
    />
  `;
}

/** Returns the first and the last time of a history, so that both pictures have one axis. */
function duration(/** @type {ChannelHistory} */ history) {
  const series = [history.measured?.t_s ?? [], ...history.model.map((m) => m.t_s)];
  const ends = series.filter((t_s) => t_s.length > 0).flatMap((t_s) => [t_s[0], t_s[t_s.length - 1]]);
  return [Math.min(...ends), Math.max(...ends)];
}
