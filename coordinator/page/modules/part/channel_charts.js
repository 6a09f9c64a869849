// Every channel of every wheel against a condition.

import { html, useMemo } from "../html.js";
import { ChannelChart } from "../chart/channel_chart.js";
import { CHANNELS } from "../words/quantity.js";

/** Low pictures are narrow, too, so that all of them stand beside each other. */
const MOST_ROWS = 3;

/**
 * @param {{ layers: import("../chart/channel_chart.js").Layer[], axis: ConditionAxis,
 *   name: string, moving?: import("../chart/channel_chart.js").Moving, small?: boolean, isLow?: boolean, order?:
 *   readonly string[] }} properties isLow: each as low as it can be read. order: of the channels
 */
export function ChannelCharts({ layers, axis, name, moving, small = false, isLow = false, order = CHANNELS }) {
  const rows = useMemo(() => measurements(layers), [layers.map((layer) => layer.name).join(), ...ends(layers)]);
  const wheels = [...new Set(rows.map((r) => r.wheel))];
  const pairs = order
    .filter((channel) => rows.some((r) => r.channel === channel))
    .flatMap((channel) =>
      (wheels.length > 1 ? wheels : [null])
        .filter((w) => w === null || rows.some((r) => r.channel === channel && r.wheel === w))
        .map((wheel) => ({ channel, wheel })),
    );
  return html`
    <div class=${`figures ${small ? "small" : ""} ${isLow && pairs.length > MOST_ROWS ? "narrow" : ""}`}>
      ${pairs.map(
        ({ channel, wheel }) =>
          html`
            <${ChannelChart}
              key=${`${channel} ${wheel}`}
              channel=${channel}
              wheel=${wheel}
              measurements=${rows}
              layers=${layers}
              axis=${axis}
              name=${name}
              moving=${moving}
              isLow=${isLow}
            />
          `,
      )}
    </div>
  `;
}

/** The first and the last layer: those between change with them. */
const ends = (/** @type {import("../chart/channel_chart.js").Layer[]} */ layers) => [
  layers[0].rows,
  layers.at(-1)?.rows,
];

/** Every measurement once: a later model may have runs that an earlier one has not. */
function measurements(/** @type {import("../chart/channel_chart.js").Layer[]} */ layers) {
  const rows = layers.flatMap((layer) => layer.rows);
  const first = new Map(rows.toReversed().map((row) => [`${row.run} ${row.channel}`, row]));
  return rows.filter((row) => first.get(`${row.run} ${row.channel}`) === row);
}

/**
 * Chooses the condition that runs are drawn against.
 * @param {{ axes: ConditionAxis[], axis: ConditionAxis, choose: (key: string) => void }}
 *   properties
 */
export function AxisPicker({ axes, axis, choose }) {
  if (axes.length < 2) return null;
  return html`
    <div class="actions" role="group" aria-label="Drawn against">
      ${axes.map(
        (a) =>
          html`
            <button type="button" aria-pressed=${a.key === axis.key} onClick=${() => choose(a.key)}>${a.title}</button>
          `,
      )}
    </div>
  `;
}
