// Who begins studies in this browser: asked once, kept here.

const KEY = "grouser.author";

export const author = {
  known: () => globalThis.localStorage?.getItem(KEY) ?? "",
  keep: (/** @type {string} */ name) => localStorage.setItem(KEY, name.trim()),
};
