// The populations of the first, a middle and the last stage in two parameters, as a report carries them (the source paper's Fig. 5).

import { colour } from "../chart/colour.js";
import { Entry, Figure, fileName } from "../chart/figure.js";
import { Plot, STYLE } from "../chart/library.js";
import { html } from "../html.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { digits, parameterName, parameterTitle } from "../words/quantity.js";

/** @param {{ id: number }} properties */
export function Populations({ id }) {
  const { answer: figures } = useAnswer(path.figures(id));
  const populations = figures?.populations;
  if (!populations) return null;
  const names = populations.parameters.map((/** @type {any} */ p) => p.name);
  const points = populations.stages.flatMap((/** @type {any} */ stage, /** @type {number} */ k) =>
    stage.points.map((/** @type {[number, number]} */ [x, y]) => ({ x, y, k, stage: stage.stage })));
  const draw = (/** @type {number} */ width) => Plot.plot({
    width: Math.min(width, 640), height: 380, marginTop: 26, marginLeft: 64, marginBottom: 40, grid: true, style: STYLE,
    x: { label: parameterTitle(names[0]), labelArrow: "none", labelAnchor: "center" }, y: { label: parameterTitle(names[1]), labelArrow: "none" },
    marks: [Plot.dot(points, { x: "x", y: "y", r: 1.8, fill: (/** @type {any} */ p) => SHADES[p.k] })],
  });
  return html`<${Figure} title=${`Populations in ${parameterName(names[0])} and ${parameterName(names[1])}`} name=${fileName("populations", id)} deps=${[populations]} draw=${draw}
    rows=${() => points.map((/** @type {any} */ p) => ({ stage: p.stage, [names[0]]: p.x, [names[1]]: p.y }))}
    legend=${populations.stages.map((/** @type {any} */ stage, /** @type {number} */ k) => html`
      <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill=${SHADES[k]} />`}>stage ${stage.stage}, exponent ${digits(stage.tempering_exponent, 2)}<//>`)} />`;
}

const SHADES = ["var(--rule)", colour(1), colour(0)];
