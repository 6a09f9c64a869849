// The parameters of a model as a table: mean and sd, 90 % interval, prior.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { digits, meanAndSd, shown, parameterName } from "../words/quantity.js";
import { Table } from "./table.js";

/** @param {{ marginals: any[], line: any }} properties line: of the ledger, or of the point estimates */
export function ParameterTable({ marginals, line }) {
  if (marginals.length === 0) {
    const rows = Object.entries(line?.parameters ?? {}).map(([name, value]) => [parameterName(name, null), digits(typeof value === "number" ? value : /** @type {any} */ (value).map, 4)]);
    return html`<${Table} label="Parameters" head=${[t`parameter (SI units)`, t`value of the fit`]} rows=${rows} numbers=${[1]} />`;
  }
  const rows = marginals.map((m) => {
    const { unit, scale } = shown(m.unit);
    const known = line?.parameters?.[m.name];
    const { mean, sd } = meanAndSd(m.mean * scale, m.sd * scale);
    const prior = known && meanAndSd(known.prior_mean * scale, known.prior_sd * scale);
    return [
      parameterName(m.name, m.unit), unit === "1" ? "" : unit, `${mean} ± ${sd}`, `${digits(m.q05 * scale, 4)} to ${digits(m.q95 * scale, 4)}`,
      digits(m.mode === null ? null : m.mode * scale, 4), prior ? `${prior.mean} ± ${prior.sd}` : "–",
      m.reference === null ? "–" : digits(m.reference * scale, 4),
      known?.at_bound ? html`<span class="state failed">at a bound of its prior</span>` : "",
    ];
  });
  return html`<${Table} label="Parameters" numbers=${[2, 3, 4, 5, 6]} rows=${rows}
    head=${[t`parameter`, t`unit`, t`mean ± sd`, t`90 % interval`, t`mode`, t`prior mean ± sd`, t`reference value`, t`remark`]} />`;
}
