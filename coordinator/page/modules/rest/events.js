// The events of a calibration as they happen. A stream that breaks is opened again: the coordinator may restart.

import { AnswerError, request, unreachable } from "./answers.js";

const AGAIN_MS = 1000;

/** The events of a text, and the rest that is not whole yet. */
export function split(/** @type {string} */ text) {
  const blocks = text.replaceAll("\r\n", "\n").split("\n\n");
  const rest = blocks.pop() ?? "";
  const events = blocks.flatMap((block) => {
    const field = (/** @type {string} */ name) =>
      block
        .split("\n")
        .filter((line) => line.startsWith(`${name}:`))
        .map((line) => line.slice(name.length + 1).trim())
        .join("\n");
    return field("data") === "" ? [] : [{ event: field("event") || "message", data: JSON.parse(field("data")) }];
  });
  return { events, rest };
}

/**
 * Follows a stream until its calibration is over; EventSource sends no token, so the stream is fetched.
 * @template {[name: string, data: unknown]} Events
 * @param {Path<unknown>} path
 * @param {{ onEvent: (...event: Events) => void, onError: (error: Error | null) => void,
 *   isOver: (...event: Events) => boolean }} listeners onError: null where the stream is open again
 * @returns {() => void} ends it
 */
export function follow(path, { onEvent, onError, isOver }) {
  const abort = new AbortController();
  let isEnded = false;
  const read = async () => {
    const response = await request("GET", path, { signal: abort.signal });
    onError(null);
    const reader = /** @type {ReadableStream<Uint8Array>} */ (response.body).getReader();
    const decoder = new TextDecoder();
    let rest = "";
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      const found = split(rest + decoder.decode(value, { stream: true }));
      rest = found.rest;
      for (const { event, data } of found.events) {
        const told = /** @type {Events} */ ([event, data]);
        onEvent(...told);
        isEnded ||= isOver(...told);
      }
    }
  };
  const loop = async () => {
    try {
      await read();
    } catch (error) {
      if (abort.signal.aborted) return;
      // A stream that breaks off while it is read fails in the words of the browser.
      const failure = error instanceof AnswerError ? error : unreachable();
      onError(failure);
      isEnded ||= [403, 404].includes(failure.status);
    }
    if (!isEnded && !abort.signal.aborted) setTimeout(loop, AGAIN_MS);
  };
  loop();
  return () => abort.abort();
}
