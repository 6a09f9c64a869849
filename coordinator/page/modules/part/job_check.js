// A job before it starts: its models and priors, what they leave out, and what it will cost.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { meanAndSpread, shownParameter } from "../words/parameter.js";
import { said, sentence } from "../words/clauses.js";
import { digits, duration } from "../words/quantity.js";
import { Table } from "./table.js";

/** @param {{ answer: Schemas["JobCheck"] }} properties */
export function JobCheck({ answer }) {
  const notes = [...answer.warnings, ...new Set(answer.models.flatMap((model) => model.limits)), ...answer.additions];
  return html`
    <section class="card check" aria-label="What the job will do">
      <h2>What the job will do</h2>
      ${answer.models.map((model) => html`<${Model} model=${model} />`)}
      ${
        notes.length > 0 && html`<h3>Good to know</h3><ul>${notes.map((note) => html`<li>${sentence(note)}</li>`)}</ul>`
      }
    </section>
  `;
}

function Model(/** @type {{ model: Schemas["CheckedModel"] }} */ { model }) {
  const rows = model.parameters.map((parameter) => {
    const called = shownParameter(parameter);
    const value = (/** @type {number | null | undefined} */ v) =>
      v === null || v === undefined ? "–" : digits(called.of(v));
    const { prior_mean: mean, prior_sd: sd } = parameter;
    const spread =
      mean === null || mean === undefined || sd === null || sd === undefined
        ? value(mean)
        : meanAndSpread(called, mean, sd);
    return [called.name, spread, value(parameter.lower), value(parameter.upper), called.unit];
  });
  return html`
    <h3>${model.model}</h3>
    <p>
      ${t`${model.fitted_runs} fitted runs with ${model.measurements} measurements, ${model.held_out_runs} held
        out`};${" "}
      ${model.algorithm}.
    </p>
    <p class="cost"><b>${costWords(model)}</b></p>
    ${
      model.cost &&
      html`
        <p class="note">
          ${said(model.cost.pilot)}
          ${
            model.cost.rejected_share > 0.005
              ? ` ${t`The model rejected ${Math.round(100 * model.cost.rejected_share)} % of its parameter vectors.`}`
              : ""
          }${" "}
          ${t`The search that may follow is not in it.`}
        </p>
      `
    }
    <details>
      <summary>Priors of ${model.parameters.length} parameters</summary>
      <${Table}
        label="Priors"
        head=${[t`parameter`, t`mean ± sd`, t`least`, t`greatest`, t`unit`]}
        rows=${rows}
        numbers=${[1, 2, 3]}
      />
    </details>
  `;
}

/** `About 9543 evaluations of 24 simulations each: 10 s on one core, 5 s on the 2 cores here`. */
function costWords(/** @type {Schemas["CheckedModel"]} */ { cost, without_cost: reason }) {
  if (!cost) return t`The cost is not known: ${reason}.`;
  const count = Number(cost.evaluations.toPrecision(2)).toLocaleString("en").replaceAll(",", "\u202f");
  const [alone, here] = [cost.core_s, cost.core_s / cost.cores].map(duration);
  return cost.is_lower_bound
    ? t`More than ${count} evaluations of ${cost.runs} simulations each: more than ${alone} on one core, ${here} on the
      ${cost.cores} cores of the service`
    : t`About ${count} evaluations of ${cost.runs} simulations each: ${alone} on one core, ${here} on the ${cost.cores}
      cores of the service`;
}
