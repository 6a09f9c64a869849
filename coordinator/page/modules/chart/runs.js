// Marks that stand for runs: they light up together in every picture, and a region of an axis chooses the runs within.

import { t } from "../language/language.js";
import { choose, point, toggle } from "../selection.js";
import { marksLike, merge, mergedRunAt } from "./merged.js";

/** A shorter way of the pointer is a click [px]. */
const LEAST_PX = 5;

/** @typedef {SVGElement & { __data__: number }} Bound an element of a mark, with the place of its datum */

/**
 * Options of a mark whose elements carry the run of their datum.
 * @template {{ run: string }} Datum
 * @template {object} Options
 * @param {Datum[]} data
 * @param {Options} options
 * @param {boolean} [isMany] whether the picture has so many marks that those of a colour are one element
 * @returns {Options & { render: import("@observablehq/plot").RenderFunction }}
 */
export function byRun(data, options, isMany = false) {
  return {
    ...options,
    render(index, scales, values, dimensions, context, next) {
      // One element is the pattern of all: those of a mark differ by place and colour alone.
      const isMerged = isMany && index.length > 0;
      const drawn = isMerged ? index.slice(0, 1) : index;
      const group = next?.(drawn, scales, values, dimensions, context) ?? null;
      const first = group?.firstElementChild;
      if (isMerged && group && first) {
        merge(
          group,
          marksLike(first, index, values, (place) => data[place].run),
        );
        return group;
      }
      for (const element of /** @type {Iterable<Bound>} */ (group?.children ?? [])) {
        const datum = data[element.__data__];
        if (datum) element.dataset.run = datum.run;
      }
      return group;
    },
  };
}

/**
 * @typedef {"pointerover" | "pointermove" | "pointerleave" | "pointerdown" | "pointerup" | "pointercancel" | "click"}
 *   PointerEventName
 */

/** The run of the mark under the pointer. */
const runAt = (/** @type {SVGSVGElement} */ plot, /** @type {MouseEvent} */ event) =>
  /** @type {SVGElement} */ (event.target).dataset?.run ?? mergedRunAt(plot, event);

/**
 * Lets a picture be pointed at: a mark lights its run, a click chooses it, a drag along x chooses all runs of a region.
 * @param {Picture} plot
 * @param {{ runsIn?: (from: number, to: number) => string[], words?: (from: number, to: number) => string }} [region]
 * @returns {() => void} removes the listeners
 */
export function pointable(plot, { runsIn, words } = {}) {
  const abort = new AbortController();
  // Ahead of the pointer of a tip, which keeps what it hears to itself.
  const on = (/** @type {PointerEventName} */ type, /** @type {(event: PointerEvent) => void} */ listener) =>
    plot.addEventListener(type, listener, { signal: abort.signal, capture: true });
  /** @type {string | undefined} */
  let under;
  const over = (/** @type {PointerEvent} */ event) => {
    const run = runAt(plot, event);
    if (event.buttons !== 0 || run === under) return;
    under = run;
    point(run ? [run] : null, run ? t`run ${run}` : "");
  };
  on("pointerover", over);
  on("pointermove", over);
  on("pointerleave", (event) => {
    if (event.target !== plot) return;
    if (under) point(null);
    under = undefined;
  });
  on("click", (event) => {
    const run = runAt(plot, event);
    if (run) toggle(run);
  });
  if (runsIn && words) drag(plot, on, runsIn, words);
  return () => abort.abort();
}

/**
 * @param {Picture} plot
 * @param {(type: PointerEventName, listener: (event: PointerEvent) => void) => void} on
 * @param {(from: number, to: number) => string[]} runsIn
 * @param {(from: number, to: number) => string} words
 */
function drag(plot, on, runsIn, words) {
  const scale = plot.scale("x");
  const [left, right] = scale.range;
  const [top, bottom] = plot
    .scale("y")
    .range.slice()
    .sort((a, b) => a - b);
  /** @type {{ from: number, band: SVGRectElement | null } | null} */
  let begun = null;
  const at = (/** @type {PointerEvent} */ event) => {
    const frame = plot.getBoundingClientRect();
    const inside = ((event.clientX - frame.left) / frame.width) * plot.viewBox.baseVal.width;
    return Math.min(right, Math.max(left, inside));
  };
  const end = () => {
    begun?.band?.remove();
    begun = null;
    point(null);
  };
  on("pointerdown", (event) => {
    if (event.button !== 0 || event.pointerType === "touch") return;
    begun = { from: at(event), band: null };
    // The tip of a picture would stay where it is when the pointer goes down beside a mark.
    if (!runAt(plot, event)) event.stopImmediatePropagation();
  });
  on("pointermove", (event) => {
    if (!begun) return;
    // Released outside: nothing told it here.
    if (event.buttons === 0) return end();
    const [from, to] = [begun.from, at(event)].sort((a, b) => a - b);
    if (!begun.band) {
      if (to - from < LEAST_PX) return;
      // Only now: a captured pointer clicks on no mark.
      plot.setPointerCapture(event.pointerId);
      plot.dispatchEvent(new PointerEvent("pointerleave", { pointerType: event.pointerType }));
      begun.band = document.createElementNS("http://www.w3.org/2000/svg", "rect");
      begun.band.setAttribute("class", "region");
      begun.band.setAttribute("y", String(top));
      begun.band.setAttribute("height", String(bottom - top));
      plot.append(begun.band);
    }
    begun.band.setAttribute("x", String(from));
    begun.band.setAttribute("width", String(to - from));
    const [low, high] = [scale.invert(from), scale.invert(to)];
    point(runsIn(low, high), words(low, high));
  });
  on("pointerup", (event) => {
    if (!begun) return;
    const [low, high] = [begun.from, at(event)].sort((a, b) => a - b).map((end) => scale.invert(end));
    const isRegion = begun.band !== null;
    end();
    if (isRegion) choose(runsIn(low, high), words(low, high));
  });
  on("pointercancel", end);
}
