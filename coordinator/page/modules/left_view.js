// How a reader left a view: how far it was scrolled, and which folded parts were open. It is kept with the view's entry
// in the history of the browser, so that going back finds it.

/** @typedef {{ top?: number, open?: string[] } | null} Left */

/** So long a view that is gone back to may take to be as it was, on a slow machine [ms]. */
const GROW_MS = 30_000;
/** What a reader does who no longer waits for the place that was left. */
const READER_MOVES = ["wheel", "touchmove", "pointerdown", "keydown"];
/** So long nothing happens before a place is kept [ms]. */
const REST_MS = 150;

/** What a folded part is known by: its own key where others have the same title, else its title. */
const keyOf = (/** @type {HTMLElement} */ part) =>
  part.dataset.fold ?? part.querySelector("summary")?.textContent ?? "";

/** Parts that were open and are not there yet. @type {Set<string>} */
let awaited = new Set();
/** Whether the view has yet to grow to the place that was left. Where it is until then is not kept. */
let isGrowing = false;

/** Keeps how a view is left. @returns {() => void} ends it */
export function keepLeftView() {
  // A browser that restores the place does so in the view that is about to go.
  history.scrollRestoration = "manual";
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const keep = () => {
    clearTimeout(timer);
    if (isGrowing) return;
    const { hash } = location;
    timer = setTimeout(() => {
      // The entry in the history is that of another view by now.
      if (location.hash !== hash) return;
      const open = [
        .../** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("#content details[open]")),
      ].map(keyOf);
      history.replaceState({ top: scrollY, open: [...new Set([...open, ...awaited])] }, "");
    }, REST_MS);
  };
  addEventListener("scroll", keep, { passive: true });
  // It does not bubble.
  document.addEventListener("toggle", keep, true);
  return () => {
    removeEventListener("scroll", keep);
    document.removeEventListener("toggle", keep, true);
  };
}

/**
 * Goes to the top of a new view, and makes one that is gone back to as it was, as soon as its parts are there.
 * @returns {() => void} ends it
 */
export function arrive() {
  const { top = 0, open = [] } = /** @type {Left} */ (history.state) ?? {};
  scrollTo(0, top);
  awaited = new Set(open);
  isGrowing = top !== 0;
  if (!isGrowing && open.length === 0) return () => undefined;
  const content = /** @type {HTMLElement} */ (document.getElementById("content"));
  const look = () => {
    for (const part of content.querySelectorAll("details")) if (awaited.delete(keyOf(part))) part.open = true;
    if (isGrowing) scrollTo(0, top);
    if (Math.abs(scrollY - top) < 2) isGrowing = false;
    if (!isGrowing && awaited.size === 0) end();
  };
  const moved = () => {
    isGrowing = false;
  };
  const parts = new MutationObserver(look);
  const size = new ResizeObserver(look);
  const end = () => {
    parts.disconnect();
    size.disconnect();
    clearTimeout(timer);
    for (const move of READER_MOVES) removeEventListener(move, moved);
    awaited.clear();
    isGrowing = false;
  };
  const timer = setTimeout(end, GROW_MS);
  for (const move of READER_MOVES) addEventListener(move, moved, { passive: true });
  parts.observe(content, { childList: true, subtree: true });
  size.observe(content);
  return end;
}
