// Predictions on a grid of conditions, from which page and report read those between: slip by monotone cubics, load and
// speed by parabolas.

import { rimSpeed } from "./words/group.js";

/**
 * @typedef {{ slip: [number, number], load: [number, number], speed: [number, number] }} Ranges
 * @typedef {{ wheel: string, slip: number, load: number, speed: number }} Place in SI; speed: of the rim or the sled,
 *   whichever the rig held
 * @typedef {{ mean: number, low: number, high: number, isMeasurement: boolean }} Spread low, high: 90 % of new
 *   measurements, or of what the parameters alone say where the noise is not known (isMeasurement: false)
 * @typedef {{ draws: number, of: number, reason: string }} Refusal at how many of the draws the model refuses a
 *   condition, and why
 * @typedef {{ wheel: string, slips: number[], loads: number[], speeds: number[], at: (Map<string, Spread> | null)[],
 *   refusals: (Refusal | null)[] }} Table at: the quantities by slip, then load, then speed; null where the model
 *   refuses. refusals: in the same order
 */

/**
 * @typedef {Schemas["PredictionGrid"]} Grid
 * @typedef {Pick<MeasuredRow, "slip" | "wheel_load_n" | "sled_speed_m_s">} Run
 * @typedef {Pick<Schemas["PredictedRun"], "refused"> & { quantities: Pick<Schemas["PredictedQuantity"], "name" |
 *   "models" | "models_mean" | "models_measurement">[] }} PredictedRun
 */

/** The speed of the sled at a slip, from the speed that the rig held. */
const sledSpeed = (/** @type {number} */ slip, /** @type {number} */ speed, /** @type {boolean} */ isRim) =>
  isRim ? (slip >= 0 ? speed * (1 - slip) : speed / (1 + slip)) : speed;

/** Ranges of a grid. @returns {Ranges} */
export const rangesOf = (/** @type {Grid["reach"]} */ { slip, wheel_load_n: load, speed_m_s: speed }) =>
  /** @type {Ranges} */ ({ slip, load, speed });

/**
 * The table of a wheel of a grid; null where the grid has none, because a prediction takes too long.
 * @returns {Table | null}
 */
export function tableOf(/** @type {Grid} */ grid, /** @type {string} */ wheel) {
  const points = grid.wheels.find((ofWheel) => ofWheel.wheel === wheel)?.points;
  if (!points) return null;
  const { slips, wheel_loads_n: loads, speeds_m_s: speeds, quantities } = grid;
  const spreadsOf = (/** @type {(number[] | null)[]} */ values) =>
    new Map(
      quantities.flatMap(({ name, is_measurement: isMeasurement }, k) => {
        const value = values[k];
        return value ? [[name, { mean: value[0], low: value[1], high: value[2], isMeasurement }]] : [];
      }),
    );
  const at = points.map(({ values }) => (values.some((value) => value !== null) ? spreadsOf(values) : null));
  return {
    wheel,
    slips,
    loads,
    speeds,
    at,
    refusals: points.map((point) => point.refused ?? null),
  };
}

/**
 * A place to begin with: the load and the speed of the fitted run that is nearest to the middle of all, a third up the
 * slips.
 */
export function middle(
  /** @type {Run[]} */ runs,
  /** @type {Ranges} */ { slip, load, speed },
  /** @type {boolean} */ isRim,
) {
  const speedOf = (/** @type {Run} */ run) => (isRim ? rimSpeed(run) : run.sled_speed_m_s);
  const off = (/** @type {number} */ value, /** @type {[number, number]} */ [low, high]) =>
    Math.abs(Math.log(value / Math.sqrt(low * high)));
  const far = (/** @type {Run} */ run) => off(run.wheel_load_n, load) + off(speedOf(run), speed);
  const nearest = runs.reduce((best, run) => (far(run) < far(best) ? run : best));
  return {
    slip: Number((slip[0] + (slip[1] - slip[0]) / 3).toPrecision(2)),
    load: nearest.wheel_load_n,
    speed: speedOf(nearest),
  };
}

/**
 * The plan of the curve at a load and a speed over the slips of a grid, which has the slip itself, too; and the table
 * that its answer fills.
 */
export function curvePlan(
  /** @type {Place} */ { wheel, slip, load, speed },
  /** @type {number[]} */ slipsOfGrid,
  /** @type {boolean} */ isRim,
) {
  const slips = [...new Set([...slipsOfGrid, slip])].sort((a, b) => a - b);
  const rows = slips.map((s) => [wheel, s, load, sledSpeed(s, speed, isRim)]);
  const plan = `${["wheel,slip,wheel_load_n,sled_speed_m_s", ...rows.map((row) => row.join(","))].join("\n")}\n`;
  const fill = (/** @type {PredictedRun[]} */ runs) => ({
    wheel,
    slips,
    loads: [load],
    speeds: [speed],
    at: spreads(runs),
    refusals: runs.map((run) => run.refused ?? null),
  });
  return { plan, fill, here: slips.indexOf(slip) };
}

/**
 * The quantities of each predicted run; null where the model refuses it. A quantity has intervals of one kind at all
 * runs, since curves and parabolas join them: those of new measurements where every run has them.
 * @returns {(Map<string, Spread> | null)[]}
 */
function spreads(/** @type {PredictedRun[]} */ runs) {
  const noiseless = new Set(
    runs.flatMap(({ quantities }) => quantities.filter((q) => !q.models_measurement).map((q) => q.name)),
  );
  return runs.map(({ quantities }) =>
    quantities.length === 0
      ? null
      : new Map(
          quantities.map((q) => {
            const isMeasurement = !noiseless.has(q.name);
            const [low, high] = (isMeasurement && q.models_measurement) || q.models;
            return [q.name, { mean: q.models_mean, low, high, isMeasurement }];
          }),
        ),
  );
}

/** The value at x of the parabola, line or point through values. */
function through(/** @type {number[]} */ xs, /** @type {number[]} */ ys, /** @type {number} */ x) {
  return ys.reduce(
    (sum, y, i) =>
      sum + y * xs.reduce((product, other, j) => (j === i ? product : (product * (x - other)) / (xs[i] - other)), 1),
    0,
  );
}

/**
 * The curve of a quantity over the slips of a table, at a load and a speed.
 * @param {Table} table
 * @param {string} quantity
 * @param {{ load: number, speed: number }} place
 * @returns {(Spread & { slip: number })[]} without slips at which the model refuses
 */
export function curve({ slips, loads, speeds, at }, quantity, { load, speed }) {
  return slips.flatMap((slip, s) => {
    const cells = loads.map((_, l) =>
      speeds.map((_, v) => at[(s * loads.length + l) * speeds.length + v]?.get(quantity)),
    );
    if (cells.some((row) => row.some((cell) => cell === undefined))) return [];
    const valueOf = (/** @type {"mean" | "low" | "high"} */ key) =>
      through(
        loads,
        cells.map((row) =>
          through(
            speeds,
            row.map((cell) => /** @type {Spread} */ (cell)[key]),
            speed,
          ),
        ),
        load,
      );
    return [
      {
        slip,
        mean: valueOf("mean"),
        low: valueOf("low"),
        high: valueOf("high"),
        isMeasurement: /** @type {Spread} */ (cells[0][0]).isMeasurement,
      },
    ];
  });
}

/**
 * Where the model refuses so many draws that a curve has no value.
 * @param {Table} table of one load and speed
 * @returns {{ spans: [number, number][], isWhole: boolean, refusal: Refusal } | null} spans: of slips beside each
 *   other. isWhole: no slip is left. refusal: that of the first. null where nothing is refused.
 */
export function refused({ slips, at, refusals }) {
  /** @type {[number, number][]} */
  const spans = [];
  slips.forEach((slip, k) => {
    if (at[k] !== null) return;
    if (k > 0 && at[k - 1] === null) /** @type {[number, number]} */ (spans.at(-1))[1] = slip;
    else spans.push([slip, slip]);
  });
  const refusal = refusals.find((refusal, k) => refusal !== null && at[k] === null);
  return refusal ? { spans, isWhole: at.every((quantities) => quantities === null), refusal } : null;
}

/** The slopes of a monotone cubic through points (Steffen 1990), as the pictures draw it. */
function slopes(/** @type {number[]} */ xs, /** @type {number[]} */ ys) {
  const secant = (/** @type {number} */ k) => (ys[k + 1] - ys[k]) / (xs[k + 1] - xs[k]);
  const inner = xs.map((_, k) => {
    if (k === 0 || k === xs.length - 1) return 0;
    const [before, after] = [secant(k - 1), secant(k)];
    const [h0, h1] = [xs[k] - xs[k - 1], xs[k + 1] - xs[k]];
    const mean = (before * h1 + after * h0) / (h0 + h1);
    return (
      (Math.sign(before) + Math.sign(after)) * Math.min(Math.abs(before), Math.abs(after), 0.5 * Math.abs(mean)) || 0
    );
  });
  const last = xs.length - 1;
  inner[0] = last > 1 ? (3 * secant(0) - inner[1]) / 2 : secant(0);
  inner[last] = last > 1 ? (3 * secant(last - 1) - inner[last - 1]) / 2 : secant(0);
  return inner;
}

/**
 * A curve at a slip; null outside of it.
 * @param {(Spread & { slip: number })[]} points
 * @param {number} slip
 * @returns {Spread | null}
 */
export function atSlip(points, slip) {
  const k = points.findIndex((point, i) => i + 1 < points.length && point.slip <= slip && slip <= points[i + 1].slip);
  if (k < 0) return null;
  const xs = points.map((point) => point.slip);
  const [h, u] = [xs[k + 1] - xs[k], (slip - xs[k]) / (xs[k + 1] - xs[k])];
  const valueOf = (/** @type {"mean" | "low" | "high"} */ key) => {
    const ys = points.map((point) => point[key]);
    const m = slopes(xs, ys);
    return (
      ys[k] * (1 + 2 * u) * (1 - u) ** 2 +
      h * m[k] * u * (1 - u) ** 2 +
      ys[k + 1] * u * u * (3 - 2 * u) +
      h * m[k + 1] * u * u * (u - 1)
    );
  };
  return { mean: valueOf("mean"), low: valueOf("low"), high: valueOf("high"), isMeasurement: points[k].isMeasurement };
}

/** The conditions of a place that lie beyond the fitted runs. @returns {("slip" | "load" | "speed")[]} */
export function beyond(/** @type {Place} */ place, /** @type {Ranges} */ fitted) {
  const close = 1e-6;
  return /** @type {const} */ (["slip", "load", "speed"]).filter((key) => {
    const [low, high] = fitted[key];
    const margin = close * Math.max(Math.abs(low), Math.abs(high));
    return place[key] < low - margin || place[key] > high + margin;
  });
}
