// Places of runs along an axis: repeats of a condition stand at one place, so that a line through them does not go up
// and down.

/** Runs at fewer places are drawn one by one. */
export const LEAST_LINE = 3;

/** Runs closer than this share of the axis stand at one place. */
const EQUAL = 0.012;

/**
 * The rows of each place, from left to right.
 * @param {any[]} rows
 * @param {(row: any) => number} x
 * @returns {any[][]}
 */
export function places(rows, x) {
  const ascending = rows.toSorted((a, b) => x(a) - x(b));
  if (ascending.length === 0) return [];
  const span = x(ascending[ascending.length - 1]) - x(ascending[0]);
  /** @type {any[][]} */
  const found = [];
  for (const row of ascending) {
    const last = found.at(-1);
    if (last && x(row) - x(last[0]) <= EQUAL * span) last.push(row);
    else found.push([row]);
  }
  return found;
}

/** The mean of a quantity over rows. */
export const meanOf = (/** @type {any[]} */ rows, /** @type {(row: any) => number} */ of) =>
  rows.reduce((sum, row) => sum + of(row), 0) / rows.length;
