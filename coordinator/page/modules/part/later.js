// A view or part whose modules are asked for when it is first shown: whoever reads a study does not wait for those of
// another view.

import { html, useEffect, useState } from "../html.js";
import { errorOf } from "../rest/answers.js";
import { Pending } from "./message.js";

/**
 * @param {{ title: string, load: () => Promise<unknown>, [property: string]: unknown }} properties load: gives the
 *   view, always the same. The other properties are those of the view.
 */
export function Later({ title, load, ...properties }) {
  const [loaded, setLoaded] = useState(
    /** @type {{ view: unknown, error: Error | null }} */ ({ view: null, error: null }),
  );
  useEffect(() => {
    load().then(
      (view) => setLoaded({ view, error: null }),
      (error) => setLoaded({ view: null, error: errorOf(error) }),
    );
  }, [load]);
  return loaded.view
    ? html`<${loaded.view} ...${properties} />`
    : html`<${Pending} answer=${null} error=${loaded.error} what=${title} />`;
}
