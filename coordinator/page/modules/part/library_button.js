// The button that adds the law of a search to the library.

import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { addToLibrary } from "../rest/routes.js";
import { Failure } from "./message.js";

/** @param {{ calibration: number }} properties calibration: whose search found the law */
export function LibraryButton({ calibration }) {
  const [name, setName] = useState(/** @type {string | null} */ (null));
  const [error, setError] = useState(/** @type {unknown} */ (null));
  const add = () => addToLibrary({ calibration }).then((law) => setName(law.name), setError);
  return html`
    <p>
      <button type="button" disabled=${name !== null} onClick=${add}>Add to the library</button>
      ${" "}
      <span class="note" role="status">
        ${
          name === null
            ? t`Later searches, of other rigs too, try this law beside the catalogue.`
            : t`${name} is tried by every search from now on`
        }
      </span>
    </p>
    <${Failure} error=${error} />
  `;
}
