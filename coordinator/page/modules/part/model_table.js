// Which model: those that the job compares, by evidence and by prediction, and what was decided.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { comparedModels, leftOutWords } from "../words/compared_model.js";
import { Table } from "./table.js";

/** @param {{ comparison: ModelComparison }} properties */
export function ModelTable({ comparison }) {
  const { head, rows } = comparedModels(comparison);
  const numbers = head.map((_, k) => k).filter((k) => k > 0 && k < head.length - 1);
  return html`
    <h2>Which model</h2>
    <${Table} label="Which model" head=${head} rows=${rows} numbers=${numbers} />
    <p class="note">
      Probabilities compare these ${comparison.models.length} models alone, from equal prior
      odds. ${leftOutWords(comparison)}. Noise sds: error over the noise; a model that is right has about 1. p of
      chi-square: how often noise alone leaves so large residuals of the fitted runs; if that of the most probable model
      is below 0.01, the answer is “none of these”.
    </p>
  `;
}
