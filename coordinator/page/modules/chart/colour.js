// Colours and signs of series: eight hues that colour-blind readers tell apart (Okabe & Ito), each with a symbol of its
// own. A times sign is none of them: it marks what a model computes at a single condition.

const SYMBOLS = /** @type {const} */ (["circle", "square", "triangle", "diamond", "star", "wye", "cross", "hexagon"]);

/** The colour of the k-th series; the style sheet has one for light and one for dark. */
export const colour = (/** @type {number} */ k) => `var(--series-${k % SYMBOLS.length})`;

/** The symbol of the k-th series. */
export const symbol = (/** @type {number} */ k) => SYMBOLS[k % SYMBOLS.length];

/** A diverging scale of standardised residuals: over-predicted, as predicted, under-predicted. */
export const RESIDUAL_RANGE = ["var(--below)", "var(--level)", "var(--above)"];
