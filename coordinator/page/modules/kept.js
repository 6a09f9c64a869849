// What a person chose for all views, kept in this browser.

/** The storage of the browser; a report within another page may have none. */
function storage() {
  try {
    return globalThis.localStorage ?? null;
  } catch {
    return null;
  }
}

/**
 * A choice among values.
 * @param {string} name
 * @param {string[]} values the first is that of who chose nothing
 * @param {string} [proposed] in its place, where it is among the values
 * @returns {{ value: string, change: (to: string) => void }} change: the page begins anew
 */
export function kept(name, values, proposed = values[0]) {
  const key = `grouser.${name}`;
  const found = [storage()?.getItem(key), proposed].find((value) => values.includes(value ?? ""));
  return {
    value: found ?? values[0],
    change(to) {
      storage()?.setItem(key, to);
      location.reload();
    },
  };
}
