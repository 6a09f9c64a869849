// Residuals in the errors that a calibration assumes or infers.

/**
 * Measured less computed, over the sd of all errors that the calibration assumes or infers, as its diagnosis judges them; null where no
 * prediction or no error is known.
 * @param {{ measured: number, predicted?: number | null, error_sd?: number | null }} row of a comparison
 */
export function residualSds({ measured, predicted = null, error_sd = null }) {
  return predicted === null || error_sd === null || !(error_sd > 0) ? null : (measured - predicted) / error_sd;
}

/** The mean sd of all errors of rows, which a band shows; null where none is known. */
export function meanErrorSd(/** @type {{ error_sd?: number | null }[]} */ rows) {
  const sds = rows.flatMap(({ error_sd: sd = null }) => (sd !== null && sd > 0 ? [sd] : []));
  return sds.length === 0 ? null : sds.reduce((sum, sd) => sum + sd, 0) / sds.length;
}
