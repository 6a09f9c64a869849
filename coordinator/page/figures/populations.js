// The populations of the first, a middle and the last stage in two parameters (the source paper's Fig. 5, bottom).

import { axis, titled } from "./axis.js";
import { frame, legend, place } from "./frame.js";
import { px } from "./text.js";

const SIZE = { width: 460, height: 340 };
const CLASSES = ["early", "middle", "late"];

/** A scatter of the populations, the last one on top. */
export function populations({ parameters, stages }) {
  const ends = (i) => {
    const values = stages.flatMap((s) => s.points.map((p) => p[i]));
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const margin = 0.03 * (high - low);
    return axis(low - margin, high + margin);
  };
  const [x, y] = [ends(0), ends(1)];
  const at = place(SIZE.width, SIZE.height, x, y);
  const offset = CLASSES.length - stages.length;
  const name = (k) => CLASSES[k + offset];
  const dots = stages.map((stage, k) => {
    // A segment without length under a round cap is a dot.
    const d = stage.points.map(([a, b]) => `M${px(at.x(a))} ${px(at.y(b))}h0`).join("");
    return `<path class="dots ${name(k)}" d="${d}"/>`;
  });
  const names = parameters.map((p) => p.name);
  const picture = frame(
    {
      ...SIZE,
      title: `Populations of the sampler in ${names.join(" and ")}, from the prior to the posterior`,
      x: { axis: x, title: titled(names[0], parameters[0].unit, x) },
      y: { axis: y, title: titled(names[1], parameters[1].unit, y) },
    },
    dots.join(""),
  );
  const entries = stages.map((stage, k) => ({
    glyph: `<path class="dots ${name(k)}" d="M8 8h0" style="stroke-width:9"/>`,
    label: `stage ${stage.stage}, tempering exponent ${Number(stage.tempering_exponent.toPrecision(2))}`,
  }));
  return picture + legend(entries);
}
