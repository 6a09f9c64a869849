// Curves that move within a drawn picture: one for each group of runs, so that a slider needs no new picture.

import { d3 } from "./library.js";
import { LEAST_LINE, meanOf, places } from "./place.js";

/** Half the width of a cross [px]. */
const CROSS = 4;

/** The number of pictures so far: each has its own name of the frame that its curves are cut to. */
let frames = 0;

/**
 * Adds the curves to a picture.
 * @param {Picture} plot
 * @param {{ rows: MeasuredRow[], stroke: string }[]} groups
 * @param {(row: MeasuredRow) => number} x
 * @returns {(y: (row: MeasuredRow) => number | undefined, isBeyond: boolean) => void} moves the curves to the value of
 *   each row, in the unit of the axis; they are dashed if the values lie beyond the draws
 */
export function movingCurves(plot, groups, x) {
  const [across, up] = ["x", "y"].map((name) => plot.scale(name));
  const layer = cut(plot, across.range, up.range);
  const curves = groups.map(({ rows, stroke }) => {
    const path = element("path", { fill: "none", stroke, "stroke-width": "2.4", "stroke-linejoin": "round" });
    layer.append(path);
    return { path, places: places(rows, x) };
  });
  return (y, isBeyond) => {
    layer.classList.toggle("beyond", isBeyond);
    for (const curve of curves) {
      const points = curve.places.flatMap((rows) => {
        const known = rows.filter((row) => y(row) !== undefined);
        if (known.length === 0) return [];
        return [pointAt(across.apply(meanOf(known, x)), up.apply(meanOf(known, (row) => y(row) ?? NaN)))];
      });
      curve.path.setAttribute("d", points.length >= LEAST_LINE ? (line(points) ?? "") : points.map(cross).join(""));
    }
  };
}

/** A group that is cut to the frame of a picture: beyond the draws a curve may go far. */
function cut(
  /** @type {SVGSVGElement} */ plot,
  /** @type {number[]} */ [left, right],
  /** @type {number[]} */ [bottom, top],
) {
  const id = `frame-${(frames += 1)}`;
  const frame = element("clipPath", { id });
  frame.append(
    element("rect", { x: String(left), y: String(top), width: String(right - left), height: String(bottom - top) }),
  );
  const layer = element("g", { class: "moving", "clip-path": `url(#${id})` });
  plot.append(frame, layer);
  return layer;
}

/** @returns {[number, number]} */
const pointAt = (/** @type {number} */ x, /** @type {number} */ y) => [x, y];

/** The same bends between points as the model's lines have. */
const line = (/** @type {[number, number][]} */ points) => d3.line().curve(d3.curveMonotoneX).digits(1)(points);

const cross = (/** @type {number[]} */ [x, y]) =>
  `M${x - CROSS} ${y - CROSS}l${2 * CROSS} ${2 * CROSS}m0 ${-2 * CROSS}l${-2 * CROSS} ${2 * CROSS}`;

function element(/** @type {string} */ name, /** @type {Record<string, string>} */ attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}
