// Joint posteriors: a triangle of small contours, and one of them large with what else is known of its parameters.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { shownParameter } from "../words/parameter.js";
import { digits, minus, tickWords, titled } from "../words/quantity.js";
import { symbol } from "./colour.js";
import { Entry, Figure, fileName } from "./figure.js";
import { glyph } from "./glyph.js";
import { d3, Plot, STYLE } from "./library.js";

/** The regions of highest density as paths in pixels; the density is given at the points of a grid. */
function regions(
  /** @type {JointPosterior} */ pair,
  /** @type {(v: number) => number} */ x,
  /** @type {(v: number) => number} */ y,
  isTurned = false,
) {
  const [xs, ys] = pair.grid;
  const geometry = d3.contours().size([xs.length, ys.length]);
  const at = (/** @type {number[]} */ axis, /** @type {number} */ k) =>
    axis[0] + ((k - 0.5) * (axis[axis.length - 1] - axis[0])) / (axis.length - 1);
  const values = pair.density.flat();
  const corner = (/** @type {number[]} */ [i, j]) => {
    const [h, v] = isTurned ? [x(at(ys, j)), y(at(xs, i))] : [x(at(xs, i)), y(at(ys, j))];
    return `${h.toFixed(1)},${v.toFixed(1)}`;
  };
  return pair.contours.map(({ density }) =>
    geometry
      .contour(values, density)
      .coordinates.flat()
      .map((ring) => `M${ring.map(corner).join("L")}Z`)
      .join(""),
  );
}

/** Sides of a cell, which grows with the room [px]. */
const SIDES = [110, 180];
const GAP = 8;
/** Left of the first column, and under the last row: a name with its unit, and ticks [px]. */
const EDGE = 76;
const UNDER = 44;
/** A character of a tick's label [px]. */
const CHARACTER = 5.4;

/**
 * @typedef {Pick<Marginal, "name" | "unit" | "bounds" | "q05" | "q95" | "mean" | "sd">} ScaledMarginal
 * @typedef {d3.Selection<SVGGElement, undefined, null, undefined>} Group
 * @typedef {d3.Selection<SVGTextElement, undefined, null, undefined>} Label
 */

/**
 * The scale of a parameter in the unit that is shown: 3.5 sds about the mean and the 90 % interval, within the bounds
 * of its prior.
 */
export function scaleOf(/** @type {ScaledMarginal} */ m, /** @type {[number, number]} */ range) {
  const { isLogarithm, of } = shownParameter(m);
  const low = Math.max(m.bounds[0] ?? -Infinity, Math.min(m.q05, m.mean - 3.5 * m.sd));
  const high = Math.min(m.bounds[1] ?? Infinity, Math.max(m.q95, m.mean + 3.5 * m.sd));
  return (isLogarithm ? d3.scaleLog() : d3.scaleLinear()).domain([of(low), of(high)]).range(range);
}

/**
 * Places of ticks of which no label reaches out of its cell or into another.
 * @param {d3.ScaleContinuousNumeric<number, number>} axis
 * @param {(label: string) => number} extent of a label along the axis [px]
 */
export function ticksOf(axis, extent) {
  const ends = [...axis.range()].sort((a, b) => a - b);
  let free = ends[0] - GAP / 2;
  return axis
    .ticks(3)
    .sort((a, b) => axis(a) - axis(b))
    .filter((v) => {
      const half = extent(tickWords(v)) / 2;
      if (axis(v) - half < free || axis(v) + half > ends[1] + GAP / 2) return false;
      free = axis(v) + half + GAP / 2;
      return true;
    });
}

/**
 * @param {{ pairs: JointPosterior[], marginals: Marginal[], name: string, onCell: (pair: JointPosterior) => void }}
 *   properties
 */
export function PairPlot({ pairs, marginals, name, onCell }) {
  const count = marginals.length;
  const pairOf = (/** @type {Marginal} */ a, /** @type {Marginal} */ b) =>
    pairs.find((p) => [a.name, b.name].every((n) => p.parameters.some((q) => q.name === n)));
  const draw = (/** @type {number} */ width) => {
    const side = Math.round(Math.max(SIDES[0], Math.min(SIDES[1], (width - EDGE) / count - GAP)));
    const whole = EDGE + count * (side + GAP);
    const ticks = (
      /** @type {Group} */ g,
      /** @type {d3.Axis<d3.NumberValue>} */ axis,
      /** @type {number[]} */ values,
    ) =>
      g
        .call(
          axis
            .tickValues(values)
            .tickFormat((v) => tickWords(Number(v)))
            .tickSize(3),
        )
        .attr("font-size", 9)
        .attr("font-family", "inherit")
        .select(".domain")
        .remove();
    const label = (/** @type {Label} */ text, /** @type {Marginal} */ m) => {
      text.attr("text-anchor", "middle").attr("font-size", 10).attr("fill", "currentColor");
      [short(shownParameter(m).name), titled("", shownParameter(m).unit).trim()].forEach((line, k) =>
        text
          .append("tspan")
          .attr("x", text.attr("x"))
          .attr("dy", k === 0 ? 0 : "1.15em")
          .text(line),
      );
    };
    const svg = d3
      .create("svg")
      .attr("viewBox", `0 0 ${whole} ${count * (side + GAP) + UNDER}`)
      .attr("width", Math.min(width, whole));
    marginals.forEach((row, j) =>
      marginals.slice(0, j + 1).forEach((column, i) => {
        const cell = svg.append("g").attr("transform", `translate(${EDGE + i * (side + GAP)},${j * (side + GAP)})`);
        cell
          .append("rect")
          .attr("width", side)
          .attr("height", side)
          .attr("fill", "transparent")
          .attr("stroke", "var(--rule)");
        // A picture of its own, at whose edge contours end.
        const inside = cell.append("svg").attr("width", side).attr("height", side).attr("overflow", "hidden");
        const [across, up] = [scaleOf(column, [0, side]), scaleOf(row, [side, 0])];
        const x = (/** @type {number} */ v) => across(shownParameter(column).of(v));
        if (i === j) {
          const top = d3.max(column.posterior) ?? 1;
          /** @type {d3.Line<number>} */
          const shape = d3.line();
          const line = shape.x((_, k) => x(column.grid[k])).y((v) => side - (0.92 * side * v) / top);
          inside
            .append("path")
            .attr("d", line(column.prior))
            .attr("fill", "none")
            .attr("stroke", "var(--prior)")
            .attr("stroke-dasharray", "4 3")
            .attr("class", "prior");
          inside
            .append("path")
            .attr("d", line(column.posterior))
            .attr("fill", "none")
            .attr("stroke", "var(--series-0)");
        } else {
          const pair = pairOf(column, row);
          if (!pair) return;
          const y = (/** @type {number} */ v) => up(shownParameter(row).of(v));
          regions(pair, x, y, pair.parameters[0].name !== column.name).forEach((d) =>
            inside
              .append("path")
              .attr("d", d)
              .attr("fill", "var(--series-0)")
              .attr("fill-opacity", 0.2)
              .attr("fill-rule", "evenodd"),
          );
          cell.style("cursor", "pointer").on("click", () => onCell(pair));
        }
        if (j === count - 1) {
          ticks(
            cell.append("g").attr("transform", `translate(0,${side})`),
            d3.axisBottom(across),
            ticksOf(across, (text) => CHARACTER * text.length),
          );
          label(
            cell
              .append("text")
              .attr("x", side / 2)
              .attr("y", side + 28),
            column,
          );
        }
        if (i === 0) {
          // The first row has a density upwards, the others their parameter.
          if (j > 0)
            ticks(
              cell.append("g"),
              d3.axisLeft(up),
              ticksOf(up, () => 10),
            );
          label(
            cell
              .append("text")
              .attr("x", 0)
              .attr("transform", `translate(-60,${side / 2}) rotate(-90)`),
            row,
          );
        }
      }),
    );
    marginals.forEach((row, j) =>
      marginals.slice(j + 1).forEach((column, further) => {
        const pair = pairOf(column, row);
        if (pair)
          correlation(
            svg
              .append("g")
              .attr("transform", `translate(${EDGE + (j + 1 + further) * (side + GAP)},${j * (side + GAP)})`),
            pair,
            side,
          );
      }),
    );
    return /** @type {SVGSVGElement} */ (svg.node());
  };
  const open = (/** @type {SelectEvent} */ { currentTarget: { value } }) =>
    value !== "" && onCell(pairs[Number(value)]);
  return html`
    <p>
      <label>
        Large picture
        of <select onChange=${open}>
          <option value="">a pair: choose it, or click its cell</option>
          ${pairs.map(
            (p, k) =>
              html`
                <option value=${k}>
                  ${p.parameters.map((q) => shownParameter(q).name).join(t` and `)}, rank
                  correlation ${digits(p.rank_correlation, 2)}
                </option>
              `,
          )}
        </select>
      </label>
    </p>
    <${Figure}
      title=${t`Joint posterior of ${marginals.map((m) => shownParameter(m).name).join(", ")}`}
      name=${fileName("pairs", name)}
      note="above the diagonal: rank correlations"
      deps=${[marginals.map((m) => m.name).join()]}
      draw=${draw}
      rows=${() => densities(pairs.filter((p) => p.parameters.every((q) => marginals.some((m) => m.name === q.name))))}
    />
  `;
}

/** The rank correlation of two parameters, the stronger the darker. */
function correlation(
  /** @type {Group} */ cell,
  /** @type {JointPosterior} */ { rank_correlation: r },
  /** @type {number} */ side,
) {
  cell
    .append("rect")
    .attr("width", side)
    .attr("height", side)
    .attr("fill", r < 0 ? "var(--below)" : "var(--above)")
    .attr("fill-opacity", (0.55 * Math.abs(r)).toFixed(2))
    .attr("stroke", "var(--rule)");
  cell
    .append("text")
    .attr("x", side / 2)
    .attr("y", side / 2 + 5)
    .attr("text-anchor", "middle")
    .attr("font-size", 14)
    .attr("fill", "currentColor")
    .text(minus(r.toFixed(2)));
}

/** A name as wide as a cell: its end tells the wheel. */
const short = (/** @type {string} */ name) => (name.length > 20 ? `${name.slice(0, 10)}…${name.slice(-9)}` : name);

/** The joint densities as rows: one for each point of each grid. */
function densities(/** @type {JointPosterior[]} */ pairs) {
  return pairs.flatMap((pair) =>
    pair.grid[0].flatMap((x, i) =>
      pair.grid[1].map((y, j) => ({
        x_parameter: pair.parameters[0].name,
        y_parameter: pair.parameters[1].name,
        x,
        y,
        density: pair.density[j][i],
      })),
    ),
  );
}

/** @typedef {JointPosterior["marks"][number]} JointMark */

/** What the picture has for a mark: a line where it fixes one parameter, else its symbol. */
function entryGlyph(/** @type {JointMark} */ mark, /** @type {number} */ k) {
  const colour = `var(--series-${(k % 7) + 1})`;
  if (typeof mark.at.y !== "number") return html`<path d="M8,1V15" stroke=${colour} stroke-width="1.5" />`;
  if (typeof mark.at.x !== "number") return html`<path d="M1,8H15" stroke=${colour} stroke-width="1.5" />`;
  return html`<g fill=${colour} color=${colour}>${glyph(k + 1)}</g>`;
}

/** @param {{ pair: JointPosterior }} properties */
export function JointPicture({ pair }) {
  const [a, b] = pair.parameters.map((p) => ({ id: p.name, ...shownParameter(p) }));
  const axis = (
    /** @type {import("../words/parameter.js").ShownParameter} */ { name, unit, isLogarithm, of },
    /** @type {number} */ k,
  ) => ({
    label: titled(name, unit),
    labelArrow: /** @type {const} */ ("none"),
    domain: [of(pair.grid[k][0]), of(pair.grid[k][pair.grid[k].length - 1])],
    tickFormat: tickWords,
    ...(isLogarithm ? { type: /** @type {const} */ ("log"), ticks: 4 } : {}),
  });
  const mark = (/** @type {JointMark} */ m, /** @type {number} */ k) => {
    const stroke = `var(--series-${(k % 7) + 1})`;
    const { x, y } = m.at;
    if (typeof x !== "number") return typeof y === "number" ? Plot.ruleY([b.of(y)], { stroke }) : null;
    if (typeof y !== "number") return Plot.ruleX([a.of(x)], { stroke });
    return Plot.dot([m], {
      x: () => a.of(x),
      y: () => b.of(y),
      symbol: symbol(k + 1),
      stroke,
      fill: stroke,
      r: 5,
    });
  };
  const title = t`Joint posterior of ${a.name} and ${b.name}`;
  return html`
    <${Figure}
      title=${title}
      note=${t`regions of ${pair.contours.map((c) => Math.round(100 * c.share)).join(", ")} % of the
        posterior; rank correlation ${digits(pair.rank_correlation, 2)}`}
      name=${fileName("joint", a.id, b.id)}
      deps=${[pair]}
      rows=${() => densities([pair])}
      legend=${pair.marks.map((m, k) => html`<${Entry} glyph=${entryGlyph(m, k)}>${m.label}<//>`)}
      draw=${(/** @type {number} */ width) =>
        Plot.plot({
          width: Math.min(width, 620),
          height: 420,
          marginLeft: 60,
          marginBottom: 40,
          grid: true,
          style: STYLE,
          x: { ticks: 6, ...axis(a, 0), labelAnchor: "center" },
          y: axis(b, 1),
          marks: [
            (_, scales) =>
              /** @type {SVGGElement} */ (
                d3
                  .create("svg:g")
                  .call((g) =>
                    regions(
                      pair,
                      (v) => Number(scales.x?.(a.of(v))),
                      (v) => Number(scales.y?.(b.of(v))),
                    ).forEach((d) =>
                      g
                        .append("path")
                        .attr("d", d)
                        .attr("fill", "var(--series-0)")
                        .attr("fill-opacity", 0.2)
                        .attr("fill-rule", "evenodd"),
                    ),
                  )
                  .node()
              ),
            ...pair.lines.map((l) =>
              Plot.line(l.points, {
                x: (p) => a.of(p[0]),
                y: (p) => b.of(p[1]),
                stroke: "var(--reference)",
                strokeDasharray: "6 4",
              }),
            ),
            ...pair.marks.map(mark),
          ],
        })}
    />
  `;
}
