// The runs that a person means: those pointed at light up in every picture, those chosen stay so until they are let go.

import { useEffect, useState } from "./html.js";
import { t } from "./language/language.js";

/** @typedef {{ runs: Set<string>, label: string }} RunSet */

/** @type {RunSet | null} */
let pointed = null;
/** @type {RunSet | null} */
let chosen = null;
/** @type {Set<() => void>} */
const watchers = new Set();

function tell() {
  light(document);
  for (const watcher of watchers) watcher();
}

/** Points at runs; null at none. */
export function point(/** @type {Iterable<string> | null} */ runs, label = "") {
  pointed = runs === null ? null : { runs: new Set(runs), label };
  tell();
}

/** Chooses runs; null lets them go. */
export function choose(/** @type {Iterable<string> | null} */ runs, label = "") {
  const set = new Set(runs ?? []);
  chosen = set.size === 0 ? null : { runs: set, label };
  tell();
}

/** Takes a run in, or out again. */
export function toggle(/** @type {string} */ run) {
  const set = new Set(chosen?.runs);
  if (!set.delete(run)) set.add(run);
  choose(set, set.size === 1 ? t`run ${[...set][0]}` : t`${set.size} runs`);
}

/** Marks what carries a run, below an element, as lit or not. */
export function light(/** @type {ParentNode} */ root) {
  const lit = pointed ?? chosen;
  document.documentElement.classList.toggle("lighting", lit !== null);
  for (const element of root.querySelectorAll("[data-run]")) {
    const run = /** @type {HTMLElement | SVGElement} */ (element).dataset.run ?? "";
    element.classList.toggle("lit", lit !== null && lit.runs.has(run));
    element.classList.toggle("chosen", chosen !== null && chosen.runs.has(run));
  }
  for (const group of root.querySelectorAll(".merged"))
    group.dispatchEvent(new CustomEvent("light", { detail: lit?.runs ?? null }));
}

/** The runs that are chosen. */
export function useChosen() {
  const [, setRound] = useState(0);
  useEffect(() => {
    const look = () => setRound((/** @type {number} */ n) => n + 1);
    watchers.add(look);
    return () => void watchers.delete(look);
  }, []);
  return chosen;
}
