// A report: every view of a study below the other, from the answers that the file carries.

import { spanWords, varying } from "./chart/condition.js";
import { html, render } from "./html.js";
import { t } from "./language/language.js";
import { ChosenRuns } from "./part/chosen_runs.js";
import { Guarded } from "./part/guarded.js";
import { Pending } from "./part/message.js";
import { Settings } from "./part/settings.js";
import { Source } from "./part/source.js";
import { recorded } from "./rest/answers.js";
import { path } from "./rest/routes.js";
import { useAnswer } from "./rest/use_answer.js";
import { ShownView, VIEWS } from "./view/views.js";
import { runWords } from "./words/ledger.js";
import { modelName, modelOf, models } from "./words/model.js";

/** Which study, and which of its calibrations, the file is about. */
const shown = JSON.parse(document.getElementById("shown")?.textContent ?? "{}");

/** The views that the file has numbers for: a decision is made only where one is asked for. */
const shownViews = (/** @type {Member} */ model) =>
  VIEWS.filter((v) => v.name !== "decide" || (model && recorded(path.decision(model.id))));

function Report() {
  const { answer: study, error } = useAnswer(path.study(shown.study));
  if (!study) return html`<${Pending} answer=${study} error=${error} what="the report" />`;
  const model = modelOf(study, shown.calibration);
  const provenance = model && recorded(path.provenance(model.id));
  return html`
    <header class="heading">
      <h1>${study.name}</h1>
      <p class="note">
        ${[...new Set([study.model_kind, model ? modelName(study, model) : t`no model`])].join(", ")}
        ${lineage(study)}
      </p>
      <p class="note">${facts(study, model, provenance)}</p>
      <${Source} campaign=${study.campaign} />
      <p class="print-brief"><button type="button" onClick=${printBrief}>Print a summary of two pages</button></p>
      <${Settings} />
      <nav class="views" aria-label="Sections">
        ${shownViews(model).map((v) => html`<a href=${`#${v.name}`}>${v.title}</a>`)}
      </nav>
    </header>
    ${shownViews(model).map(
      (v) => html`
        <section id=${v.name} class=${`view ${v.name}`}>
          ${v.name !== "story" && html`<h1 class="section">${v.title}</h1>`}
          <${Guarded} title=${v.title}><${ShownView} view=${v} study=${study} model=${model} query=${{}} /><//>
        </section>
      `,
    )}
    <${ChosenRuns} study=${study} model=${model} />
  `;
}

/**
 * When it was submitted, with how many runs, and by which program: `2026-11-27; 24 fitted runs, 16 held out; Grouser
 * 0.2.0`.
 */
function facts(
  /** @type {Study} */ study,
  /** @type {Member | null} */ model,
  /** @type {Answer<"get_provenance"> | null} */ provenance,
) {
  const day = study.created_ms ? new Date(study.created_ms).toISOString().slice(0, 10) : null;
  const line = study.ledger.find((l) => l.calibration === model?.id);
  return [day, study.details?.author, line && runWords(line), model && campaignWords(model.id), provenance?.program]
    .filter(Boolean)
    .join("; ");
}

/** What the rig was set to: `wheel w; slip 0.05 to 0.6, wheel load 60 to 140 N`. */
function campaignWords(/** @type {number} */ id) {
  const rows = recorded(path.comparison(id))?.rows ?? [];
  if (rows.length === 0) return null;
  const wheels = [...new Set(rows.map((/** @type {MeasuredRow} */ row) => row.wheel))];
  const spans = varying(rows).map((axis) => {
    const values = rows.map((/** @type {MeasuredRow} */ row) => row[axis.key] * axis.scale);
    return spanWords(axis, Math.min(...values), Math.max(...values));
  });
  return `${wheels.length === 1 ? t`wheel ${wheels[0]}` : t`wheels ${wheels.join(", ")}`}; ${spans.join(", ")}`;
}

/** Prints the story and the pictures of model and measurement, without the other sections. */
function printBrief() {
  document.body.classList.add("brief");
  addEventListener("afterprint", () => document.body.classList.remove("brief"), { once: true });
  print();
}

/** The models that were compared, and those that one of them grew into. */
function lineage(/** @type {Study} */ study) {
  const names = (/** @type {Member[]} */ members) => members.map((member) => modelName(study, member));
  const isOther = (/** @type {Member} */ member) =>
    member.id !== study.models?.best && study.models?.models.some((m) => m.calibration === member.id);
  const compared = models(study).filter((m) => m.id === study.models?.best || isOther(m));
  const line = models(study).filter((m) => !isOther(m));
  return [
    compared.length > 1 ? t`; compared: ${names(compared).join(", ")}` : "",
    study.members.length > 1 && line.length > (compared.length > 1 ? 1 : 0)
      ? t`; models: ${names(line).join(" → ")}`
      : "",
  ].join("");
}

const place = /** @type {HTMLElement} */ (document.getElementById("page"));
place.replaceChildren();
render(html`<${Report} />`, place);
