// A study: its views, and the model that they show.

import { html, useEffect, useRef } from "../html.js";
import { t, translated } from "../language/language.js";
import { Guarded } from "../part/guarded.js";
import { Later } from "../part/later.js";
import { Pending } from "../part/message.js";
import { Source } from "../part/source.js";
import { StudyActions } from "../part/study_actions.js";
import { SaidOfStudy } from "../part/study_details.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address, replace } from "../route.js";
import { choose, point, useChosen } from "../selection.js";
import { modelName, modelOf, models } from "../words/model.js";
import { ShownView, VIEWS } from "./views.js";

const chosenRuns = () => import("../part/chosen_runs.js").then((module) => module.ChosenRuns);

/** How often a study that works is looked at [ms]. */
const LOOK_MS = 1000;
/** The same of one that rests: somebody may extend it elsewhere [ms]. */
const REST_MS = 10000;
const FINAL = ["finished", "failed", "cancelled"];

/** @param {{ id: number, view: string, query: Record<string, string> }} properties */
export function StudyPage({ id, view, query }) {
  const {
    answer: study,
    error,
    reload,
  } = useAnswer(path.study(id), { everyMs: (now) => (isOver(now) ? REST_MS : LOOK_MS) });
  useEffect(
    () => () => {
      // Another study has other runs.
      choose(null);
      point(null);
    },
    [],
  );
  const shown = VIEWS.find((v) => v.name === view) ?? VIEWS[0];
  useEffect(() => {
    document.title = [shown.title, study?.name ?? t`study ${id}`, "Grouser"].join(" – ");
  }, [shown, study?.name]);
  if (!study) return html`<${Pending} answer=${study} error=${error} what=${t`study ${id}`} />`;
  const model = modelOf(study, query.model ? Number(query.model) : null);
  const to = (/** @type {string} */ name) => address(["studies", id, name], { model: query.model });
  return html`
    <div class="heading">
      <h1>${study.name}</h1>
      <p class="note">
        study ${id}, ${study.model_kind}, <span class=${`state ${study.state}`}>${translated(study.state)}</span>
      </p>
      <${SaidOfStudy} study=${study} />
      <${Source} campaign=${study.campaign} />
      ${error && html`<p class="error" role="alert">${error.message}</p>`}
    </div>
    <nav class="views" aria-label="Views of the study">
      ${VIEWS.map((v) => html`<a href=${to(v.name)} aria-current=${v === shown ? "page" : null}>${v.title}</a>`)}
    </nav>
    ${
      !["live", "errors"].includes(shown.name) &&
      html`<${ModelPicker} study=${study} model=${model} view=${shown.name} />`
    }
    <section class=${`view ${shown.name}`} aria-label=${shown.title}>
      <${Guarded} key=${`${shown.name} ${model?.id}`} title=${shown.title}>
        <${ShownView} view=${shown} study=${study} model=${model} query=${query} reload=${reload} />
      <//>
    </section>
    <${StudyActions} study=${study} reload=${reload} />
    <${ChosenRunsLater} study=${study} model=${model} asked=${query.runs} view=${shown.name} />
  `;
}

/**
 * The bar of chosen runs, which is loaded when runs are chosen first, here or by the address. It stays to take them out
 * of the address again.
 */
function ChosenRunsLater(/** @type {{ study: Study, model: Member, asked?: string, view: string }} */ properties) {
  const isNeeded = useRef(false);
  if (useChosen() || properties.asked) isNeeded.current = true;
  return isNeeded.current ? html`<${Later} title=${t`Chosen runs`} load=${chosenRuns} ...${properties} />` : null;
}

/** Which model of the study the pictures show. */
function ModelPicker(/** @type {{ study: Study, model: Member, view: string }} */ { study, model, view }) {
  const finished = models(study).filter((m) => m.state === "finished");
  if (finished.length < 2) return null;
  const go = (/** @type {SelectEvent} */ event) =>
    replace(address(["studies", study.id, view], { model: event.currentTarget.value }));
  return html`
    <p class="picker">
      <label>
        Model
        <select value=${model?.id} onChange=${go}>
          ${finished.map(
            (m) =>
              html`
                <option value=${m.id} selected=${m.id === model?.id}>
                  ${modelName(study, m)}
                  ${m.id === study.current ? t` (current)` : ""}
                </option>
              `,
          )}
        </select>
      </label>
    </p>
  `;
}

/** Whether nothing follows any more. */
export const isOver = (/** @type {Study} */ study) => FINAL.includes(study.state);
