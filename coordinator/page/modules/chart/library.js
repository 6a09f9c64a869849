// The libraries that draw: Observable Plot on D3, as vendored. They stand before the modules in the document.

const libraries =
  /** @type {typeof globalThis & { Plot: typeof import("@observablehq/plot"), d3: typeof import("d3") }} */ (
    globalThis
  );

export const { Plot, d3 } = libraries;

/** The type of every picture. */
export const STYLE = { fontSize: "12px" };
