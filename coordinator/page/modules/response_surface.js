// The response surface of a calibration: what the model puts out at a setting of its parameters, as a polynomial that
// the service fitted.

/**
 * @typedef {import("../types/api").components["schemas"]["ResponseSurface"]} ResponseSurface
 * @typedef {{ run: string, channel: string, use: string, measured: number }} Measurement
 * @typedef {{ outputs: Map<string, number>, distance: number, isBeyond: boolean }} Prediction
 *   outputs: by `key`. distance: from the posterior mean, in standard deviations of the posterior. isBeyond: whether
 *   the setting lies beyond 99 % of the draws, so that the polynomial extrapolates.
 */

/** The key of an output. */
export const key = (/** @type {{ run: string, channel: string }} */ { run, channel }) => `${channel} ${run}`;

/** The setting at the posterior mean. */
export const meanSetting = (/** @type {ResponseSurface} */ surface) =>
  surface.parameters.map((parameter) => parameter.mean);

/** The coordinate of a parameter's value: the value, or its logarithm. */
export const coordinate = (/** @type {{ logarithmic: boolean }} */ parameter, /** @type {number} */ value) =>
  parameter.logarithmic ? Math.log(value) : value;

/** The value of a parameter at a coordinate. */
export const valueAt = (/** @type {{ logarithmic: boolean }} */ parameter, /** @type {number} */ x) =>
  parameter.logarithmic ? Math.exp(x) : x;

/** The whitened coordinates of a setting, by forward substitution. */
function whitened(/** @type {ResponseSurface} */ { parameters, factor }, /** @type {number[]} */ setting) {
  /** @type {number[]} */
  const found = [];
  parameters.forEach((parameter, i) => {
    const before = found.reduce((sum, u, j) => sum + factor[i][j] * u, 0);
    found.push((coordinate(parameter, setting[i]) - parameter.centre - before) / factor[i][i]);
  });
  return found;
}

/** The terms of the polynomial at whitened coordinates, in the order of the coefficients. */
function termsAt(/** @type {ResponseSurface} */ { degree }, /** @type {number[]} */ point) {
  const products = degree === "quadratic" ? point.flatMap((a, i) => point.slice(i).map((b) => a * b)) : [];
  return [1, ...point, ...products];
}

/**
 * What the model puts out at a setting.
 * @param {ResponseSurface} surface
 * @param {number[]} setting the values of the parameters in their order
 * @returns {Prediction}
 */
export function predict(surface, setting) {
  const point = whitened(surface, setting);
  const terms = termsAt(surface, point);
  const outputs = new Map(
    surface.outputs.map((output) => [key(output), output.coefficients.reduce((sum, c, k) => sum + c * terms[k], 0)]),
  );
  const distance = Math.hypot(...point);
  return { outputs, distance, isBeyond: distance > surface.radius };
}

/**
 * A setting with another value of one parameter.
 * @param {ResponseSurface} surface
 * @param {number[]} setting
 * @param {number} index of the parameter
 * @param {number} value
 * @param {boolean} follows whether the other parameters change as they do on average among the draws, within their
 *   ranges
 */
export function changed(surface, setting, index, value, follows) {
  const { parameters, factor } = surface;
  if (!follows) return setting.map((old, i) => (i === index ? value : old));
  const covariance = (/** @type {number} */ i, /** @type {number} */ j) =>
    factor[Math.min(i, j)].reduce((sum, _, k) => sum + factor[i][k] * factor[j][k], 0);
  const step = coordinate(parameters[index], value) - coordinate(parameters[index], setting[index]);
  return parameters.map((parameter, i) => {
    if (i === index) return value;
    const moved = valueAt(
      parameter,
      coordinate(parameter, setting[i]) + (step * covariance(i, index)) / covariance(index, index),
    );
    return Math.min(parameter.upper, Math.max(parameter.lower, moved));
  });
}

/**
 * Least and greatest value of each output, where one parameter after the other goes through its range as far as the
 * draws reach.
 * @param {ResponseSurface} surface
 * @returns {Map<string, [number, number]>} by `key`
 */
export function ranges(surface) {
  const mean = meanSetting(surface);
  const ends = surface.parameters.flatMap((parameter, i) =>
    [parameter.lower, parameter.upper].map((end) => {
      const far = mean.map((value, k) => (k === i ? end : value));
      const share = Math.min(1, surface.radius / predict(surface, far).distance);
      const [from, to] = [mean[i], end].map((value) => coordinate(parameter, value));
      return mean.map((value, k) => (k === i ? valueAt(parameter, from + share * (to - from)) : value));
    }),
  );
  const all = [mean, ...ends].map((setting) => predict(surface, setting).outputs);
  return new Map(
    surface.outputs.map((output) => {
      const values = all.map((outputs) => /** @type {number} */ (outputs.get(key(output))));
      return [key(output), [Math.min(...values), Math.max(...values)]];
    }),
  );
}

/**
 * Root mean square difference between measurements and outputs.
 * @param {Measurement[]} rows
 * @param {Map<string, number>} outputs by `key`
 * @returns {number | null} null where there is no output
 */
export function rmse(rows, outputs) {
  const squares = rows.flatMap((row) => {
    const output = outputs.get(key(row));
    return output === undefined ? [] : [(row.measured - output) ** 2];
  });
  return squares.length === 0 ? null : Math.sqrt(squares.reduce((sum, square) => sum + square, 0) / squares.length);
}
