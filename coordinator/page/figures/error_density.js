// The density of a channel's prediction error over the posterior (the source paper's Fig. 8).

import { axis, titled } from "./axis.js";
import { frame, legend, path, place } from "./frame.js";
import { rule, signs } from "./mark.js";
import { shown } from "./quantity.js";
import { digits, words } from "./text.js";

const SIZE = { width: 380, height: 280 };

/** The unit of a density: 1/N, 1/(N m). */
function inverse(unit) {
  return unit.includes(" ") ? `1/(${unit})` : `1/${unit}`;
}

/** A curve over the errors, with a vertical line for the mean and for each point. */
export function errorDensity({ channel, unit, runs, grid, density, marks }) {
  const quantity = shown(unit);
  const errors = grid.map((e) => e * quantity.scale);
  const heights = density.map((f) => f / quantity.scale);
  const reach = errors[errors.length - 1];
  const x = axis(0, Math.max(reach, ...marks.map((m) => 1.05 * m.at * quantity.scale)));
  const y = axis(0, 1.08 * Math.max(0, ...heights) || 1);
  const at = place(SIZE.width, SIZE.height, x, y);
  const curve = heights.map((f, k) => [at.x(errors[k]), at.y(f)]);
  const base = at.y(0);
  const area = curve.length === 0 ? "" : `${path([[at.x(0), base], ...curve, [at.x(reach), base]])}Z`;
  const kinds = signs(marks);
  const lines = marks.map((mark, k) => {
    const p = at.x(mark.at * quantity.scale);
    const hint = `${mark.label}: ${digits(mark.at * quantity.scale)} ${quantity.unit}`;
    return rule(kinds[k], [p, base], [p, at.y(y.high)], hint);
  });
  const name = words(channel);
  const error = runs === 1 ? `|error| of ${name}` : `root mean square error of ${name}`;
  const picture = frame(
    {
      ...SIZE,
      title: `Density of the prediction error of ${name} over the posterior`,
      x: { axis: x, title: titled(error, quantity.unit, x) },
      y: { axis: y, title: titled("density", inverse(quantity.unit), y) },
    },
    `<path class="area" d="${area}"/><path class="curve density" d="${path(curve)}"/>${lines.join("")}`,
  );
  const entry = (mark, k) => ({
    glyph: rule(kinds[k], [8, 0], [8, 16]),
    label: `${mark.label} ${digits(mark.at * quantity.scale)} ${quantity.unit}`,
  });
  return picture + legend(marks.map(entry));
}
