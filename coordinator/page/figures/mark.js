// Points with a meaning: the same sign and colour in every picture.

import { escape, px } from "./text.js";

const SHAPES = {
  circle: (x, y) => `M${px(x - 4.5)} ${px(y)}a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0Z`,
  triangle: (x, y) => `M${px(x)} ${px(y - 5.5)}l5 9h-10Z`,
  square: (x, y) => `M${px(x - 4)} ${px(y - 4)}h8v8h-8Z`,
  wedge: (x, y) => `M${px(x)} ${px(y + 5.5)}l5 -9h-10Z`,
  diamond: (x, y) => `M${px(x)} ${px(y - 5.5)}l5.5 5.5l-5.5 5.5l-5.5 -5.5Z`,
};
const ESTIMATES = ["triangle", "square", "wedge"];

/** Class and shape of every mark; the point estimates have shapes of their own, in their order. */
export function signs(marks) {
  let estimates = 0;
  return marks.map((mark) => {
    if (mark.kind === "point_estimate") {
      const shape = ESTIMATES[estimates % ESTIMATES.length];
      estimates += 1;
      return { name: "estimate", shape, dash: 2 + 3 * estimates };
    }
    if (mark.kind === "reference") return { name: "reference", shape: "diamond", dash: 2 };
    if (mark.kind === "mean") return { name: "average", shape: "circle", dash: 0 };
    return { name: "likeliest", shape: "circle", dash: 0 };
  });
}

/** A sign at a pixel; a pointer that rests on it is told the hint. */
export function sign({ name, shape }, x, y, hint) {
  const title = hint ? `<title>${escape(hint)}</title>` : "";
  return `<path class="sign ${name}" d="${SHAPES[shape](x, y)}">${title}</path>`;
}

/** A straight line of a mark's colour between two pixels. */
export function rule({ name, dash }, [x1, y1], [x2, y2], hint) {
  const title = hint ? `<title>${escape(hint)}</title>` : "";
  const dashes = dash === 0 ? "" : ` stroke-dasharray="${dash} 4"`;
  return `<path class="rule ${name}"${dashes} d="M${px(x1)} ${px(y1)}L${px(x2)} ${px(y2)}">${title}</path>`;
}
