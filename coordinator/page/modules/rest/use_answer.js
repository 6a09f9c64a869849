// An answer as the state of an element: asked once, asked again every so often where it changes, kept while it is asked
// again.

import { useCallback, useEffect, useRef, useState } from "../html.js";
import { AnswerError, errorOf, get } from "./answers.js";
import { token } from "./token.js";

/** Pause before the next request after a failed one, as while the coordinator restarts [ms]. */
const RETRY_MS = 1000;

/** Whether the same question may be answered later: the coordinator, or a proxy before it, is away or busy. */
const isPassing = (/** @type {number} */ status) => status === 0 || status === 429 || status >= 500;

/**
 * The answer of a path.
 * @template Body
 * @param {Path<Body> | null} path null: nothing is asked
 * @param {{ everyMs?: (answer: Body) => number | null }} [options] how long after an answer it is asked again [ms]
 * @returns {{ answer: Body | null, error: Error | null, reload: () => void }} error: of the last look, null where it
 *   succeeded
 */
export function useAnswer(path, { everyMs = () => null } = {}) {
  const [state, setState] = useState(
    /** @type {{ path: string | null, answer: Body | null, error: Error | null }} */ ({
      path: null,
      answer: null,
      error: null,
    }),
  );
  const [round, setRound] = useState(0);
  const period = useRef(everyMs);
  period.current = everyMs;
  const reload = useCallback(() => setRound((n) => n + 1), []);
  useEffect(() => token.watch(reload), [reload]);
  useEffect(() => {
    if (path === null) return undefined;
    const abort = new AbortController();
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    const look = async () => {
      let pauseMs;
      try {
        const answer = await get(path, abort.signal);
        if (abort.signal.aborted) return;
        pauseMs = period.current(answer);
        setState({ path, answer, error: null });
      } catch (thrown) {
        if (abort.signal.aborted) return;
        const error = errorOf(thrown);
        setState((before) => ({ path, answer: before.path === path ? before.answer : null, error }));
        pauseMs = error instanceof AnswerError && isPassing(error.status) ? RETRY_MS : null;
      }
      if (pauseMs !== null) timer = setTimeout(look, pauseMs);
    };
    look();
    return () => {
      abort.abort();
      clearTimeout(timer);
    };
  }, [path, round]);
  return { answer: state.path === path ? state.answer : null, error: state.path === path ? state.error : null, reload };
}

/**
 * The answers of several paths; those that are not there yet are missing.
 * @template Body
 * @param {Path<Body>[]} paths
 * @returns {Record<string, Body>}
 */
export function useAnswers(paths) {
  const [answers, setAnswers] = useState(/** @type {Record<string, Body>} */ ({}));
  useEffect(() => {
    const abort = new AbortController();
    for (const path of paths.filter((p) => !(p in answers))) {
      get(path, abort.signal).then(
        (answer) => setAnswers((before) => ({ ...before, [path]: answer })),
        // A layer that is not there is not drawn; its own view says why.
        () => undefined,
      );
    }
    return () => abort.abort();
  }, [paths.join(" ")]);
  return answers;
}
