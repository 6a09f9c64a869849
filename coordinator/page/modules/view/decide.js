// A decision between options: their expected losses, the best and what decides it, and what one more run is worth.

import { DecisionChart } from "../chart/decision_chart.js";
import { html, useEffect, useState } from "../html.js";
import { t } from "../language/language.js";
import { DecisionForm } from "../part/decision_form.js";
import { Failure, Pending } from "../part/message.js";
import { NoModel } from "../part/no_model.js";
import { Table } from "../part/table.js";
import { isReport } from "../rest/answers.js";
import { get, path } from "../rest/routes.js";
import { loadWords, speedWords } from "../words/condition.js";
import { loss, lossWithError, percent, significant, slipDigits } from "../words/decision.js";
import { capital, digits } from "../words/quantity.js";

/** @typedef {Schemas["DecisionAnswer"]} Decision */

/** @param {{ study: Study, model: Member }} properties */
export function Decide({ study, model }) {
  const [known, setKnown] = useState(/** @type {{ decision: Decision | null, error: Error | null } | null} */ (null));
  useEffect(() => {
    if (!model) return;
    get(path.decision(model.id)).then(
      (decision) => setKnown({ decision, error: null }),
      (error) => setKnown({ decision: null, error }),
    );
  }, [model?.id]);
  if (!model) return html`<${NoModel} study=${study} />`;
  if (!known) return html`<${Pending} answer=${null} error=${null} what="the decision" />`;
  const { decision, error } = known;
  return html`
    <p class="note">
      The option with the least expected loss, over the parameters and all models of the study by their evidence, with
      the errors of one run.
    </p>
    <${Failure} error=${error} />
    ${
      decision
        ? html`<${Answer} decision=${decision} name=${study.name} />`
        : !error &&
          html`
            <p class="empty">
              ${
                isReport
                  ? t`No decision has been asked for.`
                  : t`No decision has been asked for. Name the options, such as two wheels or three ways up a slope, and
                    the loss of each: the answer says which is best, how sure that is, and what one more run is worth.
                    The example below compares climbing a slope with staying.`
              }
            </p>
          `
    }
    ${
      !isReport &&
      html`
        <${DecisionForm}
          id=${model.id}
          isOpen=${!decision}
          onDecided=${(/** @type {Decision} */ answer) => setKnown({ decision: answer, error: null })}
        />
      `
    }
  `;
}

function Answer(/** @type {{ decision: Decision, name: string }} */ { decision, name }) {
  const beyond = decision.options.flatMap((option) => option.beyond.map((what) => `${option.name}: ${what}`));
  return html`
    <div class="decision">
      <p class="verdict">${bestWords(decision)}</p>
      ${
        decision.best &&
        decision.best_at_mode &&
        decision.best_at_mode !== decision.best &&
        html`<p>${t`The most probable parameters alone would choose ${decision.best_at_mode}.`}</p>`
      }
      <${DecisionChart} decision=${decision} name=${name} />
      <${Options} decision=${decision} />
      ${beyond.map((line) => html`<p class="note">* ${t`Beyond the fitted range: ${line}.`}</p>`)}
      <${DecidedBy} decision=${decision} />
      <${Worth} decision=${decision} />
      ${decision.notes.map((note) => html`<p class="note">${capital(note)}.</p>`)}
      <p class="note">${t`${decision.draws} draws of each model.`}</p>
    </div>
  `;
}

/** The best option, and by how much. */
function bestWords(/** @type {Decision} */ { best, second, margin, margin_se: se, probability_best: probability }) {
  if (!best) return t`No option keeps all constraints.`;
  const lead =
    second && margin !== null && margin !== undefined
      ? t`${best} is the best, by ${significant(margin, 3)} ± ${significant(se ?? 0, 2)} before ${second}.`
      : t`${best} is the best.`;
  if (probability === null || probability === undefined) return lead;
  return `${lead} ${t`Over parameters and models it is the best with P ${probability.toFixed(2)}.`}`;
}

/** Every option with its loss, and the probability of each constraint. */
function Options(/** @type {{ decision: Decision }} */ { decision }) {
  const { options, best } = decision;
  const statements = options.find((option) => option.constraints.length > 0)?.constraints ?? [];
  const rows = options.map((option) => [
    html`
      ${option.name}
      ${option.beyond.length > 0 ? " *" : ""}
      ${
        option.name === best &&
        html`
          ${" "}
          <span class="state finished">best</span>
        `
      }
    `,
    lossWithError(option),
    t`${loss(option.interval[0])} to ${loss(option.interval[1])}`,
    loss(option.loss_at_mode),
    slipDigits(option.slip),
    option.stuck === null || option.stuck === undefined ? "–" : option.stuck.toFixed(2),
    ...statements.map((_, k) => {
      const constraint = option.constraints[k];
      if (!constraint) return "–";
      const isBroken = constraint.probability < constraint.needed;
      return html`
        ${constraint.probability.toFixed(2)}
        ${
          isBroken &&
          html`
            ${" "}
            <span class="state failed">too small</span>
          `
        }
      `;
    }),
  ]);
  const head = [
    t`option`,
    t`expected loss`,
    t`90 % of one run`,
    t`at the mode`,
    t`slip`,
    t`gets stuck`,
    ...statements.map(({ statement, needed }) => t`P(${statement}), at least ${needed}`),
  ];
  return html`
    <${Table} label="Options of the decision" head=${head} rows=${rows} numbers=${head.map((_, k) => k).slice(1)} />
  `;
}

/** What the difference between the two best options comes from. */
function DecidedBy(/** @type {{ decision: Decision }} */ { decision: { decided_by: by, second } }) {
  if (!by || !second) return null;
  const rows = [
    [t`the parameters`, by.parameters],
    [t`which model it is`, by.model],
    [t`errors of one run, which no run lowers`, by.noise],
  ];
  return html`
    <h2>What decides it</h2>
    <p>
      ${t`The difference to ${second} has a standard deviation of ${loss(by.sd)} in one run. Its variance comes from:`}
    </p>
    <ul class="bars" aria-label="Shares of the variance">
      ${rows.map(
        ([what, share]) =>
          html`
            <li>
              <span class="bar"><i style=${{ width: `${100 * /** @type {number} */ (share)}%` }}></i></span>
              <span class="number">${percent(/** @type {number} */ (share))}</span>
              <span>${what}</span>
            </li>
          `,
      )}
    </ul>
    ${
      by.each.length > 0 &&
      html`
        <h3>Each parameter alone explains of the mean difference</h3>
        <ul class="bars" aria-label="Shares of the parameters">
          ${by.each.map(
            ({ parameter, share }) =>
              html`
                <li>
                  <span class="bar"><i style=${{ width: `${100 * share}%` }}></i></span>
                  <span class="number">${percent(share)}</span>
                  <span>${parameter}</span>
                </li>
              `,
          )}
        </ul>
      `
    }
  `;
}

/** What one more run is worth, and whether it is worth its cost. */
function Worth(
  /** @type {{ decision: Decision }} */ { decision: { perfect_information: perfect, run_cost: cost, runs } },
) {
  if (perfect === null || perfect === undefined) return null;
  const worth = (/** @type {boolean | null | undefined} */ is) =>
    is === true ? t`more than it costs` : is === false ? t`less than it costs` : "–";
  const [first] = runs;
  const rows = runs.map((run) => [
    run.run,
    run.wheel,
    digits(run.slip, 2),
    loadWords(run.wheel_load_n),
    speedWords(run.sled_speed_m_s),
    `${significant(run.value, 3)} ± ${significant(run.value_se, 2)}`,
    worth(run.is_worth_its_cost),
  ]);
  return html`
    <h2>What one more run is worth</h2>
    <p>
      ${
        first?.is_worth_its_cost === true
          ? html`<b>One more run is worth its cost before the decision: ${first.run}.</b> `
          : first?.is_worth_its_cost === false
            ? html`<b>No further run is worth its cost.</b> `
            : ""
      }
      ${t`Knowing parameters and model would lower the expected loss by ${significant(perfect, 3)}.`}${" "}
      ${cost === null || cost === undefined ? "" : t`A run costs ${loss(cost)}.`}
    </p>
    ${
      runs.length > 0 &&
      html`
        <${Table}
          label="Further runs"
          head=${[t`run`, t`wheel`, t`slip`, t`load`, t`speed`, t`worth`, t`beside its cost`]}
          rows=${rows}
          numbers=${[2, 3, 4, 5]}
        />
      `
    }
  `;
}
