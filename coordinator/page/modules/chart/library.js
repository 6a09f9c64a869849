// The libraries that draw: Observable Plot on D3, as vendored. They stand before the modules in the document.

export const Plot = /** @type {typeof import("@observablehq/plot")} */ (/** @type {any} */ (globalThis).Plot);
export const d3 = /** @type {typeof import("d3")} */ (/** @type {any} */ (globalThis).d3);

/** The type of every picture. */
export const STYLE = { fontSize: "12px" };
