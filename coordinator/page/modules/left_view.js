// How a reader left a view: how far it was scrolled, and which folded parts were open. It is kept with the view's entry
// in the history of the browser, so that going back finds it.

/** @typedef {{ top?: number, open?: string[] } | null} Left */

/** So long a view that is gone back to may take to be as it was [ms]. */
const GROW_MS = 3000;
/** So long nothing happens before a place is kept [ms]. */
const REST_MS = 150;

/** What a folded part is known by: its own key where others have the same title, else its title. */
const keyOf = (/** @type {HTMLElement} */ part) =>
  part.dataset.fold ?? part.querySelector("summary")?.textContent ?? "";

/** Parts that were open and are not there yet. @type {Set<string>} */
let awaited = new Set();

/** Keeps how a view is left. @returns {() => void} ends it */
export function keepLeftView() {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const keep = () => {
    clearTimeout(timer);
    timer = setTimeout(() => {
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
  if (top === 0 && open.length === 0) return () => undefined;
  const content = /** @type {HTMLElement} */ (document.getElementById("content"));
  let isThere = top === 0;
  const look = () => {
    for (const part of content.querySelectorAll("details")) if (awaited.delete(keyOf(part))) part.open = true;
    if (!isThere) scrollTo(0, top);
    isThere ||= Math.abs(scrollY - top) < 2;
    if (isThere && awaited.size === 0) end();
  };
  const parts = new MutationObserver(look);
  const size = new ResizeObserver(look);
  const end = () => {
    parts.disconnect();
    size.disconnect();
    clearTimeout(timer);
    awaited.clear();
  };
  const timer = setTimeout(end, GROW_MS);
  parts.observe(content, { childList: true, subtree: true });
  size.observe(content);
  return end;
}
