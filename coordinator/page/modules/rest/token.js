// The token of this browser: it is kept here, sent to this service alone, and never put into an address.

const KEY = "grouser.token";
/** @type {Set<() => void>} */
const watchers = new Set();
let isAsked = false;

function tell() {
  for (const watcher of watchers) watcher();
}

export const token = {
  /** @returns {string | null} */
  get: () => globalThis.localStorage?.getItem(KEY) ?? null,
  /** @param {string} secret */
  set(secret) {
    localStorage.setItem(KEY, secret);
    isAsked = false;
    tell();
  },
  clear() {
    localStorage.removeItem(KEY);
    isAsked = false;
    tell();
  },
  /** The service refuses what was sent: a person is asked. */
  refused() {
    if (isAsked) return;
    isAsked = true;
    tell();
  },
  isAsked: () => isAsked,
  /**
   * @param {() => void} watcher
   * @returns {() => void} ends it
   */
  watch(watcher) {
    watchers.add(watcher);
    return () => watchers.delete(watcher);
  },
};
