// An answer as the state of an element: asked once, asked again every so often where it changes, kept while it is asked again.

import { useCallback, useEffect, useRef, useState } from "../html.js";
import { get } from "./answers.js";
import { token } from "./token.js";

/** A look fails while the coordinator restarts: the next one is so much later [ms]. */
const RETRY_MS = 1000;

/**
 * The answer of a path.
 * @template [T=any]
 * @param {string | null} path null: nothing is asked
 * @param {{ everyMs?: number | null }} [options] how often it is asked again
 * @returns {{ answer: T | null, error: any, reload: () => void }} error: of the last look, null where it succeeded
 */
export function useAnswer(path, { everyMs = null } = {}) {
  const [state, setState] = useState(/** @type {any} */ ({ path: null, answer: null, error: null }));
  const [round, setRound] = useState(0);
  const period = useRef(everyMs);
  period.current = everyMs;
  const reload = useCallback(() => setRound((/** @type {number} */ n) => n + 1), []);
  useEffect(() => token.watch(reload), [reload]);
  useEffect(() => {
    if (path === null) return undefined;
    const abort = new AbortController();
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    const look = async () => {
      let pauseMs = period.current;
      try {
        const answer = await get(path, abort.signal);
        if (abort.signal.aborted) return;
        setState({ path, answer, error: null });
      } catch (error) {
        if (abort.signal.aborted) return;
        setState((/** @type {any} */ before) => ({ path, answer: before.path === path ? before.answer : null, error }));
        if (/** @type {any} */ (error).status === 0) pauseMs = RETRY_MS;
      }
      if (pauseMs !== null) timer = setTimeout(look, pauseMs);
    };
    look();
    return () => {
      abort.abort();
      clearTimeout(timer);
    };
  }, [path, round, everyMs !== null]);
  return { answer: state.path === path ? state.answer : null, error: state.path === path ? state.error : null, reload };
}
