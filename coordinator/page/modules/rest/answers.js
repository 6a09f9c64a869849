// The public REST interface, or, within a report, its recorded answers.

import { token } from "./token.js";

/** An answer that is an error: its HTTP status, its type of the closed list, its message. */
export class AnswerError extends Error {
  /**
   * @param {number} status
   * @param {string} type
   * @param {string} message
   */
  constructor(status, type, message) {
    super(message);
    Object.assign(this, { status, type });
    this.status = status;
    this.type = type;
  }
}

/** What was thrown, as an error. */
export const errorOf = (/** @type {unknown} */ thrown) =>
  thrown instanceof Error ? thrown : new Error(String(thrown));

/** The coordinator is away, or the network is. */
export const unreachable = () =>
  new AnswerError(0, "unreachable", "the coordinator does not answer; the page goes on as soon as it does");

/** The answers that a report carries, by path; null on the page of a service. */
const carried = (() => {
  const element = globalThis.document?.getElementById("answers");
  return element ? JSON.parse(element.textContent ?? "{}") : null;
})();

/** Whether this is a report, which can ask nobody. */
export const isReport = carried !== null;

/**
 * An answer that a report carries; null on the page of a service.
 * @template Body
 * @param {Path<Body>} path
 * @returns {Body | null}
 */
export const recorded = (path) => carried?.[path] ?? null;

/**
 * Asks the service, with the token of this browser.
 * @param {string} method
 * @param {string} path
 * @param {{ body?: unknown, signal?: AbortSignal }} [options]
 */
export async function request(method, path, { body, signal } = {}) {
  /** @type {Record<string, string>} */
  const headers = {};
  if (body !== undefined) headers["content-type"] = "application/json";
  const secret = token.get();
  if (secret) headers.authorization = `Bearer ${secret}`;
  let response;
  try {
    response = await fetch(path, {
      method,
      headers,
      signal,
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch (error) {
    if (signal?.aborted) throw error;
    throw unreachable();
  }
  if (response.ok) return response;
  const text = await response.text();
  let detail = { type: "internal", message: text || response.statusText };
  try {
    detail = JSON.parse(text).error ?? detail;
  } catch {
    // A proxy in between answers in its own words.
  }
  if (response.status === 401) token.refused();
  throw new AnswerError(response.status, detail.type, detail.message);
}

/** What an answer says; one that is cut off on its way is none. */
async function body(/** @type {Response} */ response, /** @type {AbortSignal | undefined} */ signal = undefined) {
  try {
    return await response.json();
  } catch (error) {
    if (signal?.aborted) throw error;
    throw unreachable();
  }
}

/**
 * The answer to a GET request.
 * @template Body
 * @param {Path<Body>} path
 * @param {AbortSignal} [signal]
 * @returns {Promise<Body>}
 */
export async function get(path, signal) {
  if (carried) {
    if (path in carried) return carried[path];
    throw new AnswerError(404, "not_found", "this report does not carry it");
  }
  return body(await request("GET", path, { signal }), signal);
}

/**
 * The answer to a POST request.
 * @param {string} path
 * @param {unknown} [question]
 */
export async function post(path, question = {}) {
  return body(await request("POST", path, { body: question }));
}

/** The answer to a DELETE request. */
export async function remove(/** @type {string} */ path) {
  return body(await request("DELETE", path));
}
