// A report: every view of a study below the other, from the answers that the file carries.

import { html, render } from "./html.js";
import { ChosenRuns } from "./part/chosen_runs.js";
import { Guarded } from "./part/guarded.js";
import { Pending } from "./part/message.js";
import { path } from "./rest/routes.js";
import { useAnswer } from "./rest/use_answer.js";
import { VIEWS, modelName, modelOf } from "./view/study.js";

/** Which study, and which of its calibrations, the file is about. */
const shown = JSON.parse(document.getElementById("shown")?.textContent ?? "{}");

function Report() {
  const { answer: study, error } = useAnswer(path.study(shown.study));
  if (!study) return html`<${Pending} answer=${study} error=${error} what="the report" />`;
  const model = modelOf(study, shown.calibration);
  return html`
    <header class="heading">
      <h1>${study.name}</h1>
      <p class="note">${study.model_kind}, ${model ? modelName(study, model) : "no model"}${study.members.length > 1 ? html`; models: ${study.members.filter((/** @type {any} */ m) => m.kind !== "search").map((/** @type {any} */ m) => modelName(study, m)).join(" → ")}` : null}</p>
      <nav class="views" aria-label="Sections">${VIEWS.map((v) => html`<a href=${`#${v.name}`}>${v.title}</a>`)}</nav>
    </header>
    ${VIEWS.map((v) => html`
      <section id=${v.name} class=${`view ${v.name}`}>
        ${v.name !== "story" && html`<h1 class="section">${v.title}</h1>`}
        <${Guarded} title=${v.title}><${v.view} study=${study} model=${model} query=${{}} /><//>
      </section>`)}
    <${ChosenRuns} study=${study} model=${model} />`;
}

const place = /** @type {HTMLElement} */ (document.getElementById("page"));
place.replaceChildren();
render(html`<${Report} />`, place);
