// The formulas that the curve of a law may follow, in classes that it cannot tell apart.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { digits, probability } from "../words/quantity.js";
import { Table } from "./table.js";

/** @typedef {import("../../types/api").components["schemas"]["LawFormulas"]} LawFormulas */
/** @typedef {import("../../types/api").components["schemas"]["FormulaClass"]} FormulaClass */

/**
 * @param {{ formulas: LawFormulas, variable: string, add: ((effectFile: string) => void) | null }} properties variable:
 *   what the law depends on. add: adds an effect file to the model; null in a report
 */
export function Formulas({ formulas, variable, add }) {
  const rows = formulas.classes.map((group) => [
    html`<code>${group.members[0].formula}</code>`,
    probability(group.probability),
    group.members.length > 1
      ? html`
          <details>
            <summary>${t`${group.members.length - 1} alike`}</summary>
            <ul>${group.members.slice(1).map((member) => html`<li><code>${member.formula}</code></li>`)}</ul>
          </details>
        `
      : "",
    [group.below, group.above].filter(Boolean).join("; "),
    add ? html`<button type="button" onClick=${() => add(group.effect_file)}>Add this formula</button>` : "",
  ]);
  const splitting = formulas.splitting;
  return html`
    <h3>Formulas that the curve may follow</h3>
    <p>
      ${formulas.fitted} formulas were fitted to the curve. A row is a class: formulas that differ by less than half the
      curve's standard deviation, named by the simplest. Other classes together have P ${probability(formulas.others)}.
    </p>
    ${
      Boolean(formulas.through_model) &&
      html`
        <p>
          The most probable ${formulas.through_model} of them were also fitted to the measurements, through the model;
          their probabilities are from that.
        </p>
      `
    }
    ${
      splitting &&
      html`
        <p>
          The first two differ most at a ${variable} of
          ${digits(splitting.at)}${splitting.unit === "1" ? "" : ` ${splitting.unit}`} (${digits(splitting.laws[0])} and
          ${digits(splitting.laws[1])}, ${digits(splitting.sds)} sds): a run there would split them.
        </p>
      `
    }
    <${Table}
      label="Formulas of the law"
      numbers=${[1]}
      rows=${rows}
      head=${[t`formula`, t`P`, t`alike`, t`beyond the range`, ""]}
    />
  `;
}
