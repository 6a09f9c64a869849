// How searches and sampler came to their results (the source paper's Fig. 5, top).

import { axis, titled } from "./axis.js";
import { frame, legend, path, place } from "./frame.js";
import { px, words } from "./text.js";

const SIZE = { width: 460, height: 280 };

/** Best and mean log-posterior of a search by evaluations. */
export function search({ algorithm, history }) {
  const ends = history.flatMap((g) => [g.best, g.mean]).filter((v) => v !== null);
  const best = history.map((g) => g.best).filter((v) => v !== null);
  if (best.length === 0) return "<p>The model refused every individual.</p>";
  // The first generations may be worse by orders of magnitude: the axis reaches from where the best began.
  const low = Math.max(Math.min(...ends), Math.min(...best) - 0.25 * (Math.max(...best) - Math.min(...best)));
  const high = Math.max(...ends);
  const x = axis(0, history[history.length - 1].evaluations);
  const y = axis(low, high + 0.05 * (high - low));
  const at = place(SIZE.width, SIZE.height, x, y);
  const line = (key) =>
    path(history.map((g) => (g[key] === null ? null : [at.x(g.evaluations), at.y(g[key])])));
  const name = algorithm.toUpperCase();
  const picture = frame(
    {
      ...SIZE,
      title: `Convergence of ${name}: best and mean log-posterior by evaluations`,
      x: { axis: x, title: titled("evaluations", "1", x) },
      y: { axis: y, title: titled("log-posterior", "nats", y) },
    },
    `<path class="curve faint" d="${line("mean")}"/><path class="curve estimate" d="${line("best")}"/>`,
  );
  return picture + legend([
    { glyph: '<path class="curve estimate" d="M0 8h16"/>', label: `best so far (${words(algorithm)})` },
    { glyph: '<path class="curve faint" d="M0 8h16"/>', label: "mean of the generation" },
  ]);
}

/** Tempering exponents and the log-likelihoods of the populations, by evaluations. */
export function stages(list) {
  const known = list.filter((s) => s.log_likelihood !== null);
  if (known.length === 0) return "<p>The model refused every draw.</p>";
  const x = axis(0, 1.03 * list[list.length - 1].evaluations);
  const ranges = known.map((s) => s.log_likelihood);
  const high = Math.max(...ranges.map((r) => r.highest));
  // Early populations reach down without bound: the axis ends below the second stage's median.
  const low = Math.max(Math.min(...ranges.map((r) => r.q05)), 2 * ranges[Math.min(1, ranges.length - 1)].q50 - high);
  const y = axis(low, high + 0.05 * (high - low || 1));
  const at = place(SIZE.width, SIZE.height, x, y);
  const marks = known.map((s) => {
    const r = s.log_likelihood;
    const p = at.x(s.evaluations);
    const hint = `stage ${s.stage}, tempering exponent ${s.tempering_exponent.toPrecision(3)}`;
    return `<path class="interval" d="${path([[p, at.y(r.q05)], [p, at.y(r.q95)]])}"><title>${hint}</title></path>` +
      `<circle class="median" cx="${px(p)}" cy="${px(at.y(r.q50))}" r="3"><title>${hint}</title></circle>` +
      `<path class="tip" d="M${px(p - 3)} ${px(at.y(r.highest))}h6"/>`;
  });
  const line = path(known.map((s) => [at.x(s.evaluations), at.y(s.log_likelihood.q50)]));
  const picture = frame(
    {
      ...SIZE,
      title: "Log-likelihoods of the sampler's populations by evaluations, from the prior to the posterior",
      x: { axis: x, title: titled("evaluations", "1", x) },
      y: { axis: y, title: titled("log-likelihood", "nats", y) },
    },
    `<path class="path" d="${line}"/>${marks.join("")}`,
  );
  return picture + legend([
    { glyph: '<path class="interval" d="M8 0v16"/><circle class="median" cx="8" cy="8" r="3"/>', label: "median and 90 % of a stage's population" },
    { glyph: '<path class="tip" d="M5 8h6"/>', label: "highest" },
  ]);
}
