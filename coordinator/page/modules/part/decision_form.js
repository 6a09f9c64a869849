// A decision is asked for with a file, chosen or typed.

import { errorOf } from "../rest/answers.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { decide } from "../rest/routes.js";
import { Failure } from "./message.js";

const EXAMPLE = `[decision]
loss = "energy_j_m + 200 * stuck"

[[decision.options]]
name = "climb"
condition = { slope_deg = 8 }

[[decision.options]]
name = "stay"
loss = "60"
`;

/** @param {{ id: number, isOpen: boolean, onDecided: (answer: Schemas["DecisionAnswer"]) => void }} properties */
export function DecisionForm({ id, isOpen, onDecided }) {
  const [text, setText] = useState(EXAMPLE);
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isBusy, setBusy] = useState(false);
  const send = async (/** @type {Event} */ event) => {
    event.preventDefault();
    setFailure(null);
    setBusy(true);
    try {
      onDecided(await decide(id, text));
    } catch (error) {
      setFailure(errorOf(error));
    }
    setBusy(false);
  };
  const chosen = async (/** @type {FieldEvent} */ { currentTarget: field }) => {
    const [file] = field.files ?? [];
    if (file) setText(await file.text());
    field.value = "";
  };
  return html`
    <details open=${isOpen}>
      <summary>Decide by a file</summary>
      <form onSubmit=${send}>
        <p><label>A file with a table [decision] <input type="file" accept=".toml" onChange=${chosen} /></label></p>
        <textarea
          aria-label="The decision, TOML"
          spellcheck="false"
          value=${text}
          onInput=${(/** @type {FieldEvent<HTMLTextAreaElement>} */ e) => setText(e.currentTarget.value)}
        ></textarea>
        <p class="actions">
          <button class="main" type="submit" disabled=${isBusy}>
            ${isBusy ? t`is being computed …` : t`Decide now`}
          </button>
        </p>
      </form>
      <${Failure} error=${failure} />
    </details>
  `;
}
