// The story of a study in three sentences: what the model gets wrong, what is missing, what to do next; then which
// model it is of several, and how the error fell.

import { html, useState } from "../html.js";
import { LedgerCharts } from "../chart/ledger_chart.js";
import { ledgerLines } from "../chart/ledger_lines.js";
import { t } from "../language/language.js";
import { Clauses } from "../part/clauses.js";
import { Flags } from "../part/flags.js";
import { Headline } from "../part/headline.js";
import { Later } from "../part/later.js";
import { Failure } from "../part/message.js";
import { errorOf, isReport } from "../rest/answers.js";
import { discover, extend } from "../rest/routes.js";
import { address } from "../route.js";
import { sentence } from "../words/clauses.js";

// What most stories do not show is loaded when needed.
const noModel = () => import("../part/no_model.js").then((module) => module.NoModel);
const modelTable = () => import("../part/model_table.js").then((module) => module.ModelTable);
const ledger = () => import("../part/ledger.js").then((module) => module.Ledger);

/** The evidence of each model in the sentence that compares them: the table below has it. */
const EVIDENCES = / \(ln evidence [^)]*\)/;
/** So many steps are shown at first. */
const FIRST_STEPS = 3;

/** @param {{ study: Study, model: Member, reload?: () => void }} properties */
export function Story({ study, model, reload }) {
  const story = model?.story;
  const lines = ledgerLines(study);
  if (!story) {
    return html`
      ${
        study.failure
          ? html`<${StudyFailure} study=${study} />`
          : ["paused", "cancelled"].includes(study.state)
            ? html`<${Later} title=${study.name} load=${noModel} study=${study} />`
            : html`
                <p class="empty">
                  Nothing is finished yet: the story begins with the first
                  calibration. <a href=${address(["studies", study.id, "live"])}>Live</a> shows how far it is.
                </p>
              `
      }
    `;
  }
  // What it does next by itself is no advice.
  const isAtWork = !isReport && ["queued", "running"].includes(study.state);
  const to = (/** @type {string} */ view) =>
    isReport ? `#${view}` : address(["studies", study.id, view], { model: model.id });
  return html`
    <${StudyFailure} study=${study} />
    ${
      study.models &&
      html`
        <p class=${`verdict ${study.models.none_of_these ? "doubt" : ""}`}>
          ${sentence(study.models.text.replace(EVIDENCES, ""))}
        </p>
      `
    }
    <${Headline} study=${study} model=${model} reload=${reload} />
    <div class="three">
      <section class="card">
        <h2>What the model gets wrong</h2>
        <div class=${mood(story.wrong.channels)}><${Clauses} text=${story.wrong.text} /></div>
        <p class="note"><a href=${to("failures")}>Where it fails</a></p>
      </section>
      <section class="card">
        <h2>What is missing</h2>
        <${Clauses} text=${story.missing.text} />
        <p class="note"><a href=${to("effects")}>All explanations</a></p>
      </section>
      <section class="card">
        <h2>What to do next</h2>
        ${
          isAtWork &&
          html`<p>The program is at work on this study: <a href=${to("live")}>Live</a> shows how far it is.</p>`
        }
        <${Steps} steps=${isAtWork ? [] : story.next.steps} study=${study} model=${model} reload=${reload} />
        ${
          isReport &&
          story.next.steps.some((/** @type {NextStep} */ step) => step.command) &&
          html`<p class="note">Commands run in the folder of this report.</p>`
        }
      </section>
    </div>
    ${
      study.models &&
      html`<${Later} title=${t`The comparison of the models`} load=${modelTable} comparison=${study.models} />`
    }
    ${lines.length > 1 && html`<h2>How the error falls</h2><${LedgerCharts} study=${study} lines=${lines} />`}
    ${
      lines.length === 1 &&
      !study.models &&
      html`
        <h2>How large the error is</h2>
        <${Later} title=${t`The error ledger`} load=${ledger} study=${study} lines=${lines} />
      `
    }
    <${Flags} study=${study} />
  `;
}

/** Alarm where an error is no noise, calm where each is, neither where the noise of a channel is not known. */
function mood(/** @type {Story["wrong"]["channels"]} */ channels) {
  if (channels.every((c) => c.is_within_noise)) return "calm";
  return channels.some((c) => c.is_judged && !c.is_within_noise) || channels.length === 0 ? "alarm" : "";
}

/** Why a study failed, and what to do. */
function StudyFailure(/** @type {{ study: Study }} */ { study }) {
  if (!study.failure) return null;
  return html`
    <section class="card" role="alert">
      <h2>
        ${study.members.length > 1 ? t`Calibration ${study.failure.calibration} failed` : t`The calibration failed`}
      </h2>
      <p class="error">${sentence(study.failure.reason)}</p>
      <p><b>What to do:</b> ${sentence(study.failure.advice)}</p>
      ${
        !isReport &&
        html`<p><a class="button main" href=${address(["new"], { study: study.id })}>Edit and start again</a></p>`
      }
    </section>
  `;
}

/** The first steps; the others are folded. */
function Steps(
  /** @type {{ steps: NextStep[], study: Study, model: Member, reload?: () => void }} */ { steps, ...given },
) {
  const list = (/** @type {NextStep[]} */ some, start = 1) =>
    html`<ol start=${start}>${some.map((step) => html`<li><${Step} step=${step} ...${given} /></li>`)}</ol>`;
  const later = steps.slice(FIRST_STEPS);
  return html`
    ${list(steps.slice(0, FIRST_STEPS))}
    ${
      later.length > 0 &&
      html`
        <details>
          <summary>${later.length === 1 ? t`1 more step` : t`${later.length} more steps`}</summary>
          ${list(later, FIRST_STEPS + 1)}
        </details>
      `
    }
  `;
}

/**
 * A step with the button that takes it; a report has the command.
 * @param {{ step: NextStep, study: Study, model: Member, reload?: () => void }} properties
 */
function Step({ step, study, model, reload }) {
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isBusy, setBusy] = useState(false);
  const act = async (/** @type {() => Promise<Schemas["CalibrationCreated"]>} */ what) => {
    setBusy(true);
    setFailure(null);
    try {
      const created = await what();
      reload?.();
      location.hash = address(["studies", created.study ?? study.id, "live"]);
    } catch (error) {
      setFailure(errorOf(error));
    }
    setBusy(false);
  };
  const buttons = /** @type {Partial<Record<NextStep["kind"], () => unknown>>} */ ({
    add_effect: () =>
      html`
        <button
          class="main"
          type="button"
          disabled=${isBusy}
          onClick=${() =>
            act(() =>
              extend(model.id, step.wheel ? { effect: step.effect, wheel: step.wheel } : { effect: step.effect }),
            )}
        >
          Add ${step.effect}
        </button>
      `,
    add_effect_file: () =>
      html`
        <button
          class="main"
          type="button"
          disabled=${isBusy}
          onClick=${() => act(() => extend(model.id, { effect_file: step.effect_file }))}
        >
          Add this law
        </button>
      `,
    discover: () =>
      html`
        <button class="main" type="button" disabled=${isBusy} onClick=${() => act(() => discover(model.id))}>
          Search for the missing effect
        </button>
      `,
    predict: () =>
      study.current !== model.id
        ? html`
            <a class="button" href=${address(["studies", study.id, "story"], { model: study.current })}>
              Go to the current model
            </a>
          `
        : html`<a class="button" href=${address(["studies", study.id, "predict"], { model: model.id })}>Predict</a>`,
    make_runs: () =>
      html`
        <a class="button" href=${address(["studies", study.id, "effects"], { model: step.calibration })}>
          See the runs, and add them
        </a>
      `,
  });
  const button = !isReport && model && buttons[step.kind];
  const call = button
    ? html`<span class="actions">${button()}</span>`
    : step.command && html`<code>coordinator ${step.command}${isReport ? " --out ." : ""}</code>`;
  return html`
    ${sentence(step.text)}${" "}
    ${
      step.detail &&
      html`
        <details data-fold=${step.text}>
          <summary>In detail</summary>
          <span class="note">${sentence(step.detail)}</span>
        </details>
      `
    }
    ${call}
    <${Failure} error=${failure} />
  `;
}
