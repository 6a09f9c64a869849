// Pause, resume and cancel of a calibration.

import { errorOf } from "../rest/answers.js";
import { html, useState } from "../html.js";
import { control } from "../rest/routes.js";
import { Failure } from "./message.js";

/** @param {{ id: number, state: string, reload: () => void }} properties */
export function Controls({ id, state, reload }) {
  const [isAsked, setAsked] = useState(false);
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const send = async (/** @type {"pause" | "resume" | "cancel"} */ verb) => {
    setFailure(null);
    setAsked(false);
    try {
      await control(id, verb);
      reload();
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  return html`
    <div class="actions" role="group" aria-label="Control of the calibration">
      ${
        state === "paused"
          ? html`<button class="main" type="button" onClick=${() => send("resume")}>Resume</button>`
          : html`<button type="button" onClick=${() => send("pause")}>Pause</button>`
      }
      ${
        isAsked
          ? html`
              <span>Cancel for good? Its stages so far stay, and it cannot go on.</span>
              <button type="button" onClick=${() => send("cancel")}>Cancel it</button>
              <button type="button" onClick=${() => setAsked(false)}>Keep it</button>
            `
          : html`<button type="button" onClick=${() => setAsked(true)}>Cancel</button>`
      }
    </div>
    <${Failure} error=${failure} />
  `;
}
