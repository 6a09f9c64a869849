// The address of what is shown, behind the `#`: `#/studies/3/compare?model=5`. Whoever gets the address sees the same.

import { useEffect, useMemo, useState } from "./html.js";

/** @typedef {{ place: string[], query: Record<string, string> }} Route */

/**
 * The parts of an address.
 * @param {string} hash
 * @returns {Route}
 */
export function parse(hash) {
  const [path, query] = hash.replace(/^#\/?/, "").split("?");
  return {
    place: path.split("/").filter(Boolean).map(decoded),
    query: Object.fromEntries(new URLSearchParams(query ?? "")),
  };
}

/** A part of an address; one that is mistyped stands as it is. */
function decoded(/** @type {string} */ part) {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

/**
 * The address of its parts; what is null or empty is left out.
 * @param {(string | number)[]} place
 * @param {Record<string, string | number | null | undefined>} [query]
 */
export function address(place, query = {}) {
  const given = Object.entries(query).filter(([, value]) => value !== null && value !== undefined && value !== "");
  const search = new URLSearchParams(given.map(([key, value]) => [key, String(value)])).toString();
  return `#/${place.map((part) => encodeURIComponent(String(part))).join("/")}${search ? `?${search}` : ""}`;
}

/** Goes to an address without a new entry in the history of the browser. */
export function replace(/** @type {string} */ to) {
  history.replaceState(null, "", to);
  dispatchEvent(new HashChangeEvent("hashchange"));
}

/** Where the browser is. */
export function useRoute() {
  const [hash, setHash] = useState(location.hash);
  useEffect(() => {
    const look = () => setHash(location.hash);
    addEventListener("hashchange", look);
    // An effect runs after the first view is painted: an address that changed until then is not announced any more.
    look();
    return () => removeEventListener("hashchange", look);
  }, []);
  return useMemo(() => parse(hash), [hash]);
}
