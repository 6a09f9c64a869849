// Takes back what was added to a study: the study is as before, and the same addition brings it again without being
// computed anew.

import { errorOf } from "../rest/answers.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { withdraw } from "../rest/routes.js";
import { address } from "../route.js";
import { Failure } from "./message.js";

/**
 * @param {{ study: Study, id: number, label?: string, reload?: () => void }} properties id: of the calibration that was
 *   added
 */
export function TakeBack({ study, id, label = t`Take back`, reload }) {
  const [isAsked, setAsked] = useState(false);
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const take = async () => {
    setFailure(null);
    setAsked(false);
    try {
      await withdraw(id);
      reload?.();
      location.hash = address(["studies", study.id, "story"]);
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  return html`
    <span class="take-back">
      ${
        isAsked
          ? html`
              <span>The study goes on without it, and without what followed from it.</span>
              <button type="button" onClick=${take}>Take it back</button>
              <button type="button" onClick=${() => setAsked(false)}>Keep it</button>
            `
          : html`<button type="button" onClick=${() => setAsked(true)}>${label}</button>`
      }
      <${Failure} error=${failure} />
    </span>
  `;
}

/** The calibration that added an effect to a model; null where none did. */
export function additionOf(/** @type {Study} */ study, /** @type {string[]} */ effects) {
  const found = study.members.find(
    (m) => m.kind !== "search" && m.effects.length > 0 && m.effects.join(" ") === effects.join(" "),
  );
  return found?.id ?? null;
}

/** Whether a model has something that the submitted one has not. */
export const isAddition = (/** @type {Study} */ study, /** @type {Member} */ model) =>
  model.effects.length > 0 && study.members[0].id !== model.id;
