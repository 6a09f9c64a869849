// A joint posterior density with what else is known of its parameters (the source paper's Fig. 6).

import { axis, titled } from "./axis.js";
import { rings } from "./contour.js";
import { frame, legend, path, place } from "./frame.js";
import { rule, sign, signs } from "./mark.js";
import { digits } from "./text.js";

const SIZE = { width: 460, height: 360 };

/** Filled highest-density contours, points and lines. */
export function posterior(pair) {
  const [x, y] = pair.range.map(([low, high]) => {
    const margin = 0.04 * (high - low);
    return axis(low - margin, high + margin);
  });
  const at = place(SIZE.width, SIZE.height, x, y);
  const layers = pair.contours.map(({ share, density }) => {
    const closed = rings(pair.grid, pair.density, density);
    const d = closed.map((ring) => `${path(ring.map(([a, b]) => [at.x(a), at.y(b)]))}Z`).join("");
    return `<path class="region" fill-rule="evenodd" d="${d}"><title>${share * 100} % of the posterior</title></path>`;
  });
  const lines = pair.lines.map(({ label, points }) =>
    rule({ name: "reference", dash: 6 }, ...points.map(([a, b]) => [at.x(a), at.y(b)]), label));
  const kinds = signs(pair.marks);
  const points = pair.marks.map((mark, k) => point(mark, kinds[k], at, x, y));
  const names = pair.parameters.map((p) => p.name);
  const picture = frame(
    {
      ...SIZE,
      title: `Joint posterior density of ${names.join(" and ")}`,
      x: { axis: x, title: titled(names[0], pair.parameters[0].unit, x) },
      y: { axis: y, title: titled(names[1], pair.parameters[1].unit, y) },
    },
    [...layers, ...lines, ...points].join(""),
  );
  const shares = pair.contours.map((c) => Math.round(c.share * 100)).join(", ");
  return picture + legend([
    { glyph: '<path class="region" d="M1 1h14v14h-14Z"/><path class="region" d="M4 4h8v8h-8Z"/>', label: `${shares} % of the posterior` },
    ...pair.marks.map((mark, k) => ({ glyph: glyph(mark, kinds[k]), label: mark.label })),
    ...pair.lines.map(({ label }) => ({ glyph: rule({ name: "reference", dash: 6 }, [0, 8], [16, 8]), label })),
  ]);
}

/** A mark as it looks in the legend. */
function glyph(mark, kind) {
  if (mark.at.y === null) return rule(kind, [8, 0], [8, 16]);
  if (mark.at.x === null) return rule(kind, [0, 8], [16, 8]);
  return sign(kind, 8, 8);
}

/** A sign where both coordinates are known; a line across where one is. */
function point(mark, kind, at, x, y) {
  const known = [mark.at.x, mark.at.y].filter((v) => v !== null).map((v) => digits(v, 4));
  const hint = `${mark.label}: ${known.join(", ")}`;
  if (mark.at.y === null) return rule(kind, [at.x(mark.at.x), at.y(y.low)], [at.x(mark.at.x), at.y(y.high)], hint);
  if (mark.at.x === null) return rule(kind, [at.x(x.low), at.y(mark.at.y)], [at.x(x.high), at.y(mark.at.y)], hint);
  return sign(kind, at.x(mark.at.x), at.y(mark.at.y), hint);
}
