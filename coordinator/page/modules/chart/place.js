// Places of runs along an axis: repeats of a condition stand at one place, so that a line through them does not go up
// and down.

/** Runs at fewer places are drawn one by one. */
export const LEAST_LINE = 3;

/** Runs closer than this share of the axis stand at one place. */
const EQUAL = 0.012;

/**
 * The rows of each place, from left to right.
 * @template Row
 * @param {Row[]} rows
 * @param {(row: Row) => number} x
 * @returns {Row[][]}
 */
export function places(rows, x) {
  const ascending = rows.toSorted((a, b) => x(a) - x(b));
  if (ascending.length === 0) return [];
  const span = x(ascending[ascending.length - 1]) - x(ascending[0]);
  /** @type {Row[][]} */
  const all = [];
  for (const row of ascending) {
    const last = all.at(-1);
    if (last && x(row) - x(last[0]) <= EQUAL * span) last.push(row);
    else all.push([row]);
  }
  return all;
}

/**
 * The mean of a quantity over rows.
 * @template Row
 * @param {Row[]} rows
 * @param {(row: Row) => number} valueOf
 */
export const meanOf = (rows, valueOf) => rows.reduce((sum, row) => sum + valueOf(row), 0) / rows.length;
