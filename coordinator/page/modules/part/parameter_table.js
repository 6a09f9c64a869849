// The parameters of a model as a table: mean and sd, 90 % interval, prior.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { digits, meanAndSd, parameterName, shown, withSd } from "../words/quantity.js";
import { Table } from "./table.js";

/** What a logarithm is in the unit itself: `45.7 kPa (41.7 to 49.8)`; blank of what is none. */
function ofLogarithm(/** @type {any} */ { unit: stated, mean, q05, q95 }) {
  const [, base] = /^log10 (.+)$/.exec(stated) ?? [];
  if (base === undefined) return "";
  const { unit, scale } = shown(base);
  const [value, low, high] = [mean, q05, q95].map((exponent) => digits(10 ** exponent * scale));
  return t`${value} ${unit} (${low} to ${high})`;
}

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
    const [low, high, mode] = withSd([m.q05 * scale, m.q95 * scale, m.mode === null ? null : m.mode * scale], m.sd * scale);
    return [
      parameterName(m.name, m.unit), unit === "1" ? "" : unit, `${mean} ± ${sd}`, t`${low} to ${high}`, mode, prior ? `${prior.mean} ± ${prior.sd}` : "–",
      m.reference === null ? "–" : digits(m.reference * scale, 4),
      html`${ofLogarithm(m)} ${known?.at_bound && html`<span class="state failed">at a bound of its prior</span>`}`,
    ];
  });
  return html`<${Table} label="Parameters" numbers=${[2, 3, 4, 5, 6]} rows=${rows}
    head=${[t`parameter`, t`unit`, t`mean ± sd`, t`90 % interval`, t`mode`, t`prior mean ± sd`, t`reference value`, t`remark`]} />`;
}
