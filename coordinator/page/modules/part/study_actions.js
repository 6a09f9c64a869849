// What can be done with a study as a whole: begin again from its files, take it out of the list, delete it for good.

import { errorOf } from "../rest/answers.js";
import { fileName } from "../chart/figure.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { archive, deleteStudy, path, reportOf } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address } from "../route.js";
import { Later } from "./later.js";
import { Failure } from "./message.js";

const files = () => import("../chart/download.js");
const detailsForm = () => import("./details_form.js").then((module) => module.DetailsForm);
const AT_WORK = ["queued", "running", "paused"];

/** @param {{ study: Study, reload: () => void }} properties */
export function StudyActions({ study, reload }) {
  const [isAsked, setAsked] = useState(false);
  const [isDescribed, setDescribed] = useState(false);
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const act = async (/** @type {() => Promise<unknown>} */ what, /** @type {() => void} */ then) => {
    setFailure(null);
    setAsked(false);
    try {
      await what();
      then();
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  const { current } = study;
  const saveReport = async () => {
    if (typeof current === "number") (await files()).save(`${fileName(study.name)}.html`, await reportOf(current));
  };
  const isAtWork = AT_WORK.includes(study.state);
  return html`
    ${
      isDescribed &&
      html`
        <${Later}
          title="Name, author, tags, note"
          load=${detailsForm}
          study=${study}
          reload=${reload}
          close=${() => setDescribed(false)}
        />
      `
    }
    <div class="actions study-actions" role="group" aria-label="What to do with the study">
      <button type="button" aria-expanded=${isDescribed} onClick=${() => setDescribed(!isDescribed)}>
        Name, author, tags, note
      </button>
      ${
        typeof current === "number" &&
        html`<button type="button" onClick=${() => act(saveReport, () => undefined)}>Save the report</button>`
      }
      <a class="button" href=${address(["new"], { study: study.id })}>Edit and start again</a>
      <${BesideAnother} study=${study} />
      ${
        !isAtWork &&
        html`
          <button
            type="button"
            onClick=${() => act(() => archive(study.id, study.archived ? "restore" : "archive"), reload)}
          >
            ${study.archived ? t`Take back into the list` : t`Archive`}
          </button>
        `
      }
      ${
        !isAtWork &&
        (isAsked
          ? html`
              <span>Delete ${study.name} with all its results, for good?</span>
              <button
                type="button"
                onClick=${() =>
                  act(
                    () => deleteStudy(study.id),
                    () => {
                      location.hash = "#/";
                    },
                  )}
              >
                Delete it
              </button>
              <button type="button" onClick=${() => setAsked(false)}>Keep it</button>
            `
          : html`<button type="button" onClick=${() => setAsked(true)}>Delete</button>`)
      }
    </div>
    <${Failure} error=${failure} />
  `;
}

/** Chooses another study to be shown beside this one; the list is asked for at the first touch. */
function BesideAnother(/** @type {{ study: Study }} */ { study }) {
  const [isTouched, setTouched] = useState(false);
  const { answer } = useAnswer(isTouched ? path.studies : null);
  const others = (answer ?? []).filter((other) => other.id !== study.id).reverse();
  const go = (/** @type {SelectEvent} */ { currentTarget: { value } }) =>
    value && (location.hash = address(["beside", study.id, value]));
  return html`
    <label>
      Beside <select onFocus=${() => setTouched(true)} onPointerDown=${() => setTouched(true)} onChange=${go}>
        <option value="">another study</option>
        ${others.map((other) => html`<option value=${other.id}>${other.name} (study ${other.id})</option>`)}
      </select>
    </label>
  `;
}
