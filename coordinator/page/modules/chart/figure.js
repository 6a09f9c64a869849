// A picture with its title, its legend and its downloads; it is drawn anew when its width or its numbers change.

import { html, useEffect, useRef, useState } from "../html.js";
import { t } from "../language/language.js";
import { light } from "../selection.js";
import { words } from "../words/quantity.js";

/** The module that saves files; it is loaded at the first download. */
const files = () => import("./download.js");

/** @typedef {Record<string, string | number | boolean | null | undefined>} Row */

/**
 * @template {Element} Drawn
 * @param {{
 *   title: string, name: string, deps: unknown[],
 *   draw: (width: number) => Drawn,
 *   rows?: () => Row[], note?: unknown, legend?: unknown, onDrawn?: (plot: Drawn) => (() => void) | void,
 * }} properties
 *   title: what a reader who cannot see it is told. name: of the files. draw: the picture at a width [px].
 *   rows: its numbers. onDrawn: adds listeners; what it returns removes them.
 */
export function Figure({ title, name, deps, draw, rows, note, legend, onDrawn }) {
  const place = useRef(/** @type {HTMLElement | null} */ (null));
  const [width, setWidth] = useState(0);
  const [failure, setFailure] = useState(/** @type {string | null} */ (null));
  useEffect(() => {
    const element = /** @type {HTMLElement} */ (place.current);
    const observer = new ResizeObserver(([entry]) => setWidth(Math.round(entry.contentRect.width)));
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    if (width === 0) return undefined;
    let plot;
    try {
      plot = draw(width);
    } catch (error) {
      setFailure(t`this picture cannot be drawn: ${/** @type {Error} */ (error).message}`);
      return undefined;
    }
    setFailure(null);
    plot.setAttribute("role", "img");
    plot.setAttribute("aria-label", title);
    // Plot names groups that have no role, which screen readers refuse.
    for (const group of plot.querySelectorAll("g[aria-label]")) group.removeAttribute("aria-label");
    /** @type {HTMLElement} */ (place.current).replaceChildren(plot);
    light(plot);
    return onDrawn?.(plot) ?? undefined;
  }, [width, ...deps]);
  const figure = () => /** @type {HTMLElement} */ (place.current?.closest("figure"));
  const saveAs = async (/** @type {"svg" | "png" | "csv"} */ kind) => {
    try {
      const { csv, png, save, svg } = await files();
      const content = { svg: () => svg(figure()), png: () => png(figure()), csv: () => csv(rows?.() ?? []) };
      save(`${name}.${kind}`, await content[kind]());
    } catch (error) {
      setFailure(t`this picture cannot be saved: ${/** @type {Error} */ (error).message}`);
    }
  };
  return html`
    <figure data-figure=${name}>
      <figcaption>
        <b>${title}</b>
        ${
          note
            ? html`
                ${" "}
                <span class="note">${note}</span>
              `
            : null
        }
      </figcaption>
      <div class="plot" ref=${place}></div>
      ${failure && html`<p class="error">${failure}</p>`}
      ${legend && html`<div class="legend">${legend}</div>`}
      <div class="downloads" role="toolbar" aria-label=${t`download: ${title}`} onKeyDown=${roam}>
        <button type="button" onClick=${() => saveAs("svg")}>SVG</button>
        <button type="button" tabindex="-1" onClick=${() => saveAs("png")}>PNG</button>
        ${rows && html`<button type="button" tabindex="-1" onClick=${() => saveAs("csv")}>CSV</button>`}
      </div>
    </figure>
  `;
}

/** Arrows go between the buttons of a toolbar, which is one stop of the tab key. */
function roam(/** @type {KeyboardEvent} */ event) {
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (step === undefined) return;
  const buttons = [.../** @type {HTMLElement} */ (event.currentTarget).querySelectorAll("button")];
  const at = buttons.indexOf(/** @type {HTMLButtonElement} */ (event.target));
  buttons[(at + step + buttons.length) % buttons.length].focus();
}

/**
 * An entry of a legend: a glyph in 16 by 16 pixels, and its name.
 * @param {{ glyph: unknown, children?: unknown }} properties
 */
export function Entry({ glyph, children }) {
  return html`<span><svg class="glyph" viewBox="0 0 16 16" aria-hidden="true">${glyph}</svg>${children}</span>`;
}

/** The name of a file: letters of every language stay. */
export const fileName = (/** @type {unknown[]} */ ...parts) =>
  parts
    .map((p) =>
      words(String(p))
        .replace(/[^\p{L}\p{N}.+-]+/gu, "-")
        .replace(/^-+|-+$/g, ""),
    )
    .filter(Boolean)
    .join("-");
