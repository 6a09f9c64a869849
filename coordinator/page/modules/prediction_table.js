// Predictions on a grid of conditions, from which the page reads those between: slip by monotone cubics, load and speed by parabolas.

import { rimSpeed } from "./words/group.js";

/**
 * @typedef {{ slip: [number, number], load: [number, number], speed: [number, number] }} Ranges
 * @typedef {{ wheel: string, slip: number, load: number, speed: number }} Place in SI; speed: of the rim or the sled, whichever the rig held
 * @typedef {{ mean: number, low: number, high: number, isMeasurement: boolean }} Spread low, high: 90 % of new measurements, or of what the
 *   parameters alone say where the noise is not known (isMeasurement: false)
 * @typedef {{ draws: number, of: number, reason: string }} Refusal at how many of the draws the model refuses a condition, and why
 * @typedef {{ wheel: string, slips: number[], loads: number[], speeds: number[], at: (Map<string, Spread> | null)[], refusals: (Refusal | null)[] }} Table
 *   at: the quantities by slip, then load, then speed; null where the model refuses. refusals: in the same order
 */

/** Slips of a curve. */
const SLIPS = 11;
/** A wheel goes no faster on its spot. */
const MOST_SLIP = 0.95;
/** How far beyond the fitted runs a slider reaches. */
const BEYOND_SLIP = 0.2;
const BEYOND = 1.3;
/** Levels of a speed that differ by less are one. */
const ONE_LEVEL = 0.02;

const ends = (/** @type {number[]} */ values) => /** @type {[number, number]} */ ([Math.min(...values), Math.max(...values)]);

/** The number of levels among values. */
function levels(/** @type {number[]} */ values) {
  const sorted = values.toSorted((a, b) => a - b);
  return sorted.filter((value, k) => k === 0 || value > sorted[k - 1] * (1 + ONE_LEVEL)).length;
}

/** Whether the rig held the speed of the rim: then that of the sled falls with the slip. */
export const holdsRim = (/** @type {any[]} */ runs) => levels(runs.map(rimSpeed)) < levels(runs.map((run) => run.sled_speed_m_s));

/** The speed of the sled at a slip, from the speed that the rig held. */
const sledSpeed = (/** @type {number} */ slip, /** @type {number} */ speed, /** @type {boolean} */ isRim) => (isRim ? (slip >= 0 ? speed * (1 - slip) : speed / (1 + slip)) : speed);

/**
 * What the fitted runs span.
 * @param {any[]} runs with their conditions
 * @returns {Ranges}
 */
export function fittedRanges(runs) {
  const isRim = holdsRim(runs);
  return { slip: ends(runs.map((run) => run.slip)), load: ends(runs.map((run) => run.wheel_load_n)), speed: ends(runs.map((run) => (isRim ? rimSpeed(run) : run.sled_speed_m_s))) };
}

/** A place to begin with: the load and the speed of the fitted run that is nearest to the middle of all, a third up the slips. */
export function middle(/** @type {any[]} */ runs, /** @type {Ranges} */ { slip, load, speed }) {
  const isRim = holdsRim(runs);
  const speedOf = (/** @type {any} */ run) => (isRim ? rimSpeed(run) : run.sled_speed_m_s);
  const off = (/** @type {number} */ value, /** @type {[number, number]} */ [low, high]) => Math.abs(Math.log(value / Math.sqrt(low * high)));
  const far = (/** @type {any} */ run) => off(run.wheel_load_n, load) + off(speedOf(run), speed);
  const nearest = runs.reduce((best, run) => (far(run) < far(best) ? run : best));
  return { slip: Number((slip[0] + (slip[1] - slip[0]) / 3).toPrecision(2)), load: nearest.wheel_load_n, speed: speedOf(nearest) };
}

/** Where the sliders end: some way beyond the fitted runs. @returns {Ranges} */
export function reach(/** @type {Ranges} */ { slip, load, speed }) {
  const wider = (/** @type {[number, number]} */ [low, high]) => /** @type {[number, number]} */ ([low / BEYOND, high * BEYOND]);
  return { slip: [Math.min(0, slip[0]), Math.min(MOST_SLIP, slip[1] + BEYOND_SLIP)], load: wider(load), speed: speed[1] > speed[0] * (1 + ONE_LEVEL) ? wider(speed) : speed };
}

/** The slips of a curve: closer where it bends, near 0. */
function slipsOf(/** @type {[number, number]} */ [low, high]) {
  return Array.from({ length: SLIPS }, (_, k) => low + (high - low) * (k / (SLIPS - 1)) ** 1.5);
}

const three = (/** @type {[number, number]} */ [low, high]) => (low === high ? [low] : [low, Math.sqrt(low * high), high]);

/** The plan of a request, and the table that its answer fills. */
function planOf(/** @type {string} */ wheel, /** @type {number[]} */ slips, /** @type {number[]} */ loads, /** @type {number[]} */ speeds, /** @type {boolean} */ isRim) {
  const rows = slips.flatMap((slip) => loads.flatMap((load) => speeds.map((speed) => [wheel, slip, load, sledSpeed(slip, speed, isRim)])));
  const plan = `${["wheel,slip,wheel_load_n,sled_speed_m_s", ...rows.map((row) => row.join(","))].join("\n")}\n`;
  return { plan, fill: (/** @type {any[]} */ runs) => ({ wheel, slips, loads, speeds, at: spreads(runs), refusals: runs.map((run) => run.refused ?? null) }) };
}

/** The plan of a grid over all conditions. */
export const gridPlan = (/** @type {string} */ wheel, /** @type {Ranges} */ { slip, load, speed }, /** @type {boolean} */ isRim) => planOf(wheel, slipsOf(slip), three(load), three(speed), isRim);

/** The plan of the curve at a load and a speed, which has the slip itself, too. */
export function curvePlan(/** @type {Place} */ { wheel, slip, load, speed }, /** @type {Ranges} */ ranges, /** @type {boolean} */ isRim) {
  const slips = [...new Set([...slipsOf(ranges.slip), slip])].sort((a, b) => a - b);
  return { ...planOf(wheel, slips, [load], [speed], isRim), here: slips.indexOf(slip) };
}

/**
 * The quantities of each predicted run; null where the model refuses it. A quantity has intervals of one kind at all runs, since curves and
 * parabolas join them: those of new measurements where every run has them.
 * @returns {(Map<string, Spread> | null)[]}
 */
function spreads(/** @type {any[]} */ runs) {
  const noiseless = new Set(runs.flatMap(({ quantities }) => quantities.filter((/** @type {any} */ q) => q.models_measurement === null).map((/** @type {any} */ q) => q.name)));
  return runs.map(({ quantities }) => (quantities.length === 0 ? null : new Map(quantities.map((/** @type {any} */ q) => {
    const isMeasurement = !noiseless.has(q.name);
    const [low, high] = isMeasurement ? q.models_measurement : q.models;
    return [q.name, { mean: q.models_mean, low, high, isMeasurement }];
  }))));
}

/** The value at x of the parabola, line or point through values. */
function through(/** @type {number[]} */ xs, /** @type {number[]} */ ys, /** @type {number} */ x) {
  return ys.reduce((sum, y, i) => sum + y * xs.reduce((product, other, j) => (j === i ? product : (product * (x - other)) / (xs[i] - other)), 1), 0);
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
    const cells = loads.map((_, l) => speeds.map((_, v) => at[(s * loads.length + l) * speeds.length + v]?.get(quantity)));
    if (cells.some((row) => row.some((cell) => cell === undefined))) return [];
    const of = (/** @type {"mean" | "low" | "high"} */ key) => through(loads, cells.map((row) => through(speeds, row.map((cell) => /** @type {Spread} */ (cell)[key]), speed)), load);
    return [{ slip, mean: of("mean"), low: of("low"), high: of("high"), isMeasurement: /** @type {Spread} */ (cells[0][0]).isMeasurement }];
  });
}

/**
 * Where the model refuses so many draws that a curve has no value.
 * @param {Table} table of one load and speed
 * @returns {{ spans: [number, number][], isWhole: boolean, refusal: Refusal } | null} spans: of slips beside each other. isWhole: no slip is
 *   left. refusal: that of the first. null where nothing is refused.
 */
export function refused({ slips, at, refusals }) {
  /** @type {[number, number][]} */
  const spans = [];
  slips.forEach((slip, k) => {
    if (at[k] !== null) return;
    if (k > 0 && at[k - 1] === null) /** @type {[number, number]} */ (spans.at(-1))[1] = slip;
    else spans.push([slip, slip]);
  });
  const refusal = refusals.find((one, k) => one !== null && at[k] === null);
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
    return (Math.sign(before) + Math.sign(after)) * Math.min(Math.abs(before), Math.abs(after), 0.5 * Math.abs(mean)) || 0;
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
  const of = (/** @type {"mean" | "low" | "high"} */ key) => {
    const ys = points.map((point) => point[key]);
    const m = slopes(xs, ys);
    return ys[k] * (1 + 2 * u) * (1 - u) ** 2 + h * m[k] * u * (1 - u) ** 2 + ys[k + 1] * u * u * (3 - 2 * u) + h * m[k + 1] * u * u * (u - 1);
  };
  return { mean: of("mean"), low: of("low"), high: of("high"), isMeasurement: points[k].isMeasurement };
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
