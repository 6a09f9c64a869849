// An axis: a range of values, its ticks at 1-2-5 steps, and where a value lies on the picture.

import { power } from "./text.js";

/** The step of 1, 2 or 5 times a power of ten that divides a length into about so many parts. */
function niceStep(length, about) {
  const rough = length / about;
  const magnitude = 10 ** Math.floor(Math.log10(rough));
  const factor = [1, 2, 5, 10].find((f) => f * magnitude >= rough * (1 - 1e-9));
  return factor * magnitude;
}

/** The power of ten that tick labels leave out: 0, or a multiple of 3 for very large and very small values. */
function exponentOf(low, high) {
  const largest = Math.max(Math.abs(low), Math.abs(high));
  if (largest === 0 || (largest < 1e5 && largest >= 1e-2)) return 0;
  return 3 * Math.floor(Math.log10(largest) / 3);
}

/**
 * An axis from `low` to `high`; a range without length is widened. With `log`, equal ratios; both ends are then > 0.
 * The result has no pixels yet: `on(start, end)` gives it some.
 */
export function axis(low, high, { about = 7, log = false } = {}) {
  if (!(high - low > 1e-12 * Math.max(Math.abs(low), Math.abs(high)))) {
    const half = Math.abs(low) * 0.05 || 1;
    [low, high] = log ? [low / 2, low * 2] : [low - half, low + half];
  }
  const forward = log ? Math.log10 : (value) => value;
  const share = (value) => (forward(value) - forward(low)) / (forward(high) - forward(low));
  const exponent = log ? 0 : exponentOf(low, high);
  return {
    low,
    high,
    exponent,
    ticks: log ? ratioTicks(low, high) : evenTicks(low, high, about, exponent),
    holds: (value) => value >= low && value <= high,
    on: (start, end) => (value) => start + share(value) * (end - start),
  };
}

function evenTicks(low, high, about, exponent) {
  const step = niceStep(high - low, about);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) - exponent + 1e-9));
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  const ticks = [];
  for (let k = first; k <= last; k += 1) {
    // k + 0: no tick is called -0
    ticks.push({ value: k * step, label: ((k + 0) * step / 10 ** exponent).toFixed(decimals) });
  }
  return ticks;
}

function ratioTicks(low, high) {
  const ticks = [];
  for (let k = Math.ceil(Math.log10(low) - 1e-9); 10 ** k <= high * (1 + 1e-9); k += 1) {
    ticks.push({ value: 10 ** k, label: power(k) });
  }
  return ticks;
}

/** A title with its unit, and with the power of ten that the labels leave out. */
export function titled(name, unit, { exponent }) {
  const factor = exponent === 0 ? "" : power(exponent);
  const inside = [factor, unit === "1" ? "" : unit].filter(Boolean).join(" ");
  return inside ? `${name} [${inside}]` : name;
}
