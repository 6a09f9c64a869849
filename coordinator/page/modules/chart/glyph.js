// The symbols of series in a legend, in 16 by 16 pixels.

import { html } from "../html.js";
import { symbol } from "./colour.js";

const GLYPHS = /** @type {Record<string, unknown>} */ ({
  circle: html`<circle cx="8" cy="8" r="4" />`,
  square: html`<rect x="4" y="4" width="8" height="8" />`,
  triangle: html`<path d="M8 3l5 9H3z" />`,
  diamond: html`<path d="M8 3l4 5l-4 5l-4 -5z" />`,
  star: html`<path d="M8 2l1.6 4h4l-3.2 2.6 1.2 4.2L8 10.4l-3.6 2.4 1.2-4.2L2.4 6h4z" />`,
  wye: html`<path d="M7 8L3 4l2-2 3 4 3-4 2 2-4 4v6H7z" />`,
  cross: html`<path d="M6 2h4v4h4v4h-4v4H6v-4H2V6h4z" />`,
  hexagon: html`<path d="M8 3l4.3 2.5v5L8 13l-4.3-2.5v-5z" />`,
});

/** The symbol of the k-th series, as a picture has it. */
export const glyph = (/** @type {number} */ k) => GLYPHS[symbol(k)];
