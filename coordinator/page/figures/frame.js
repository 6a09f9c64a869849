// The frame of a picture: axes with ticks and titles around the marks, and a legend below.

import { escape, px } from "./text.js";

const MARGINS = { left: 66, right: 14, top: 12, bottom: 44 };

/** The pixels of both axes on a picture of this size. */
export function place(width, height, x, y) {
  const { left, right, top, bottom } = MARGINS;
  return { x: x.on(left, width - right), y: y.on(height - bottom, top) };
}

/**
 * A picture as SVG: `title` is what a reader who cannot see it is told, `marks` is drawn inside the axes and cut off there.
 * `x` and `y` are `{ axis, title }`.
 */
export function frame({ title, width, height, x, y }, marks) {
  const { left, right, top, bottom } = MARGINS;
  const at = place(width, height, x.axis, y.axis);
  const [w, h] = [width - left - right, height - top - bottom];
  const low = height - bottom;
  const parts = [];
  for (const { value, label } of x.axis.ticks) {
    const p = px(at.x(value));
    parts.push(`<line class="grid" x1="${p}" x2="${p}" y1="${top}" y2="${low}"/>`);
    parts.push(`<text x="${p}" y="${low + 15}" text-anchor="middle">${label}</text>`);
  }
  for (const { value, label } of y.axis.ticks) {
    const p = px(at.y(value));
    parts.push(`<line class="grid" x1="${left}" x2="${width - right}" y1="${p}" y2="${p}"/>`);
    parts.push(`<text x="${left - 5}" y="${px(at.y(value) + 3.5)}" text-anchor="end">${label}</text>`);
  }
  const inside = `x="${left}" y="${top}" width="${w}" height="${h}"`;
  parts.push(`<svg ${inside} viewBox="${left} ${top} ${w} ${h}">${marks}</svg>`);
  parts.push(`<rect class="frame" ${inside}/>`);
  const middle = `x="${px(left + w / 2)}" y="${height - 8}"`;
  parts.push(`<text class="axis" ${middle} text-anchor="middle">${escape(x.title)}</text>`);
  const side = `translate(13 ${px(top + h / 2)}) rotate(-90)`;
  parts.push(`<text class="axis" transform="${side}" text-anchor="middle">${escape(y.title)}</text>`);
  const name = escape(title);
  return `<svg role="img" aria-label="${name}" viewBox="0 0 ${width} ${height}"><title>${name}</title>${parts.join("")}</svg>`;
}

/** A legend: for each entry its glyph, drawn around (8, 8) of 16 by 16 pixels, and its name. */
export function legend(entries) {
  const entry = ({ glyph, label }) =>
    `<span><svg class="glyph" viewBox="0 0 16 16" aria-hidden="true">${glyph}</svg>${escape(label)}</span>`;
  return entries.length === 0 ? "" : `<div class="legend">${entries.map(entry).join("")}</div>`;
}

/** A path through points, `null` where it breaks. */
export function path(points) {
  let pen = "M";
  let d = "";
  for (const point of points) {
    if (point === null) {
      pen = "M";
      continue;
    }
    d += `${pen}${px(point[0])} ${px(point[1])}`;
    pen = "L";
  }
  return d;
}
