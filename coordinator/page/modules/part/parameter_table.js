// The parameters of a model as a table: mean and sd, 90 % interval, prior.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { meanAndSpread, parameterValues, shownParameter } from "../words/parameter.js";
import { digits, parameterName } from "../words/quantity.js";
import { Table } from "./table.js";

/**
 * @param {{ marginals: Marginal[], line?: LedgerEntry | PointEstimate }} properties line: of the ledger, or of the
 *   point estimates
 */
export function ParameterTable({ marginals, line }) {
  if (marginals.length === 0) {
    /** @type {Record<string, number | Schemas["ParameterSummary"]>} */
    const estimates = line?.parameters ?? {};
    const rows = Object.entries(estimates).map(([name, value]) => [
      parameterName(name, null),
      digits(typeof value === "number" ? value : value.map, 4),
    ]);
    return html`
      <${Table} label="Parameters" head=${[t`parameter (SI units)`, t`value of the fit`]} rows=${rows} numbers=${[1]} />
    `;
  }
  const rows = marginals.map((m) => {
    const called = shownParameter(m);
    const summary = line?.parameters[m.name];
    const known = typeof summary === "object" ? summary : null;
    const [low, high, mode] = parameterValues(called, [m.q05, m.q95, m.mode], m.mean, m.sd);
    return [
      called.name,
      called.unit,
      meanAndSpread(called, m.mean, m.sd),
      t`${low} to ${high}`,
      mode,
      typeof known?.prior_mean === "number" && typeof known.prior_sd === "number"
        ? meanAndSpread(called, known.prior_mean, known.prior_sd)
        : "–",
      typeof m.reference === "number" ? digits(called.of(m.reference), 4) : "–",
      html`
        ${called.isLogarithm && html`<code>${m.name}</code>`}${" "}
        ${known?.at_bound && html`<span class="state failed">at a bound of its prior</span>`}
      `,
    ];
  });
  const hasFactor = marginals.some((m) => shownParameter(m).isLogarithm);
  return html`
    <${Table}
      label="Parameters"
      numbers=${[2, 3, 4, 5, 6]}
      rows=${rows}
      head=${[
        t`parameter`,
        t`unit`,
        t`mean ± sd`,
        t`90 % interval`,
        t`mode`,
        t`prior mean ± sd`,
        t`reference value`,
        t`remark`,
      ]}
    />
    ${
      hasFactor &&
      html`<p class="note">×/÷: the job has the decimal logarithm of the parameter; one sd is this factor.</p>`
    }
  `;
}
