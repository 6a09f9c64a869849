// Measurement and model over time (the source paper's Fig. 7).

import { axis, titled } from "./axis.js";
import { frame, legend, path, place } from "./frame.js";
import { signs } from "./mark.js";
import { shown } from "./quantity.js";
import { words } from "./text.js";

const SIZE = { width: 620, height: 240 };

/** One channel of one run: the measured line, where there is a recording, and the model's on top. */
export function history({ run, channel, unit, measured, model }) {
  const quantity = shown(unit);
  const recordings = measured === null ? [] : [measured];
  const times = [...recordings, ...model].flatMap((s) => s.t_s);
  const values = [...recordings, ...model].flatMap((s) => s.value).map((v) => v * quantity.scale);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const x = axis(Math.min(...times), Math.max(...times), { about: 10 });
  const y = axis(low - 0.05 * (high - low), high + 0.05 * (high - low));
  const at = place(SIZE.width, SIZE.height, x, y);
  const line = (series) =>
    path(series.t_s.map((t, k) => [at.x(t), at.y(series.value[k] * quantity.scale)]));
  const kinds = signs(model.map(({ label }) => ({
    kind: label === "maximum likelihood" ? "maximum_likelihood" : "point_estimate",
  })));
  const computed = model.map((series, k) => `<path class="curve ${kinds[k].name}" d="${line(series)}"/>`);
  const name = words(channel);
  const picture = frame(
    {
      ...SIZE,
      title: `Time history of ${name} in run ${run}: ${measured === null ? "" : "measured, and "}computed at ${model.map((m) => m.label).join(" and ")}`,
      x: { axis: x, title: titled("time", "s", x) },
      y: { axis: y, title: titled(name, quantity.unit, y) },
    },
    recordings.map((series) => `<path class="curve measured" d="${line(series)}"/>`).join("") + computed.join(""),
  );
  return picture + legend([
    ...recordings.map(() => ({ glyph: '<path class="curve measured" d="M0 8h16"/>', label: "measured" })),
    ...model.map(({ label }, k) => ({ glyph: `<path class="curve ${kinds[k].name}" d="M0 8h16"/>`, label })),
  ]);
}
