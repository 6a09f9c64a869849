// The libraries that draw: Observable Plot on D3, as vendored. They stand before the modules in the document.

import { language } from "../language/language.js";

const libraries =
  /** @type {typeof globalThis & { Plot: typeof import("@observablehq/plot"), d3: typeof import("d3") }} */ (
    globalThis
  );

export const { Plot, d3 } = libraries;

// Ticks have the decimal mark of the page: 2,000 is two for a German reader.
if (language === "de")
  d3?.formatDefaultLocale({ decimal: ",", thousands: "\u202f", grouping: [3], currency: ["", ""] });

/** The type of every picture. */
export const STYLE = { fontSize: "12px" };
