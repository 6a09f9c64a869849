// Residuals in the errors that a calibration assumes or infers.

/**
 * @typedef {"all" | "noise"} Errors all errors that a calibration assumes or infers, as its diagnosis judges residuals,
 *   or its noise alone
 */
/** @typedef {{ error_sd?: number | null, noise_sd?: number | null }} Row of a comparison */

/** The sd of a row's errors; null where it is not known. */
function sdOf(/** @type {Row} */ { error_sd = null, noise_sd = null }, /** @type {Errors} */ errors) {
  const sd = errors === "all" ? error_sd : noise_sd;
  return sd !== null && sd > 0 ? sd : null;
}

/**
 * Measured less computed, over the sd of the errors; null where no prediction or no error is known.
 * @param {Row & { measured: number, predicted?: number | null }} row
 * @param {Errors} errors
 */
export function residualSds(row, errors) {
  const { measured, predicted = null } = row;
  const sd = sdOf(row, errors);
  return predicted === null || sd === null ? null : (measured - predicted) / sd;
}

/** The mean sd of the errors of rows, which a band shows; null where none is known. */
export function meanErrorSd(/** @type {Row[]} */ rows, /** @type {Errors} */ errors) {
  const sds = rows.flatMap((row) => sdOf(row, errors) ?? []);
  return sds.length === 0 ? null : sds.reduce((sum, sd) => sum + sd, 0) / sds.length;
}

/** Whether the noise of every row is known, and is all the error that a calibration has. */
export function hasOnlyNoise(/** @type {Row[]} */ rows) {
  return rows.every((row) => sdOf(row, "noise") !== null) && !hasErrorsBesideNoise(rows);
}

/** Whether a calibration has errors beside its noise, so that the two differ. */
export function hasErrorsBesideNoise(/** @type {Row[]} */ rows) {
  return rows.some((row) => (sdOf(row, "all") ?? 0) > 1.001 * (sdOf(row, "noise") ?? Infinity));
}
