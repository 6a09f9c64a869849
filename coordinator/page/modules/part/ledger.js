// The error ledger as a table.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { dataSets, runWords } from "../words/ledger.js";
import { CHANNELS, errorWords, minus, short, shown, titled, unitOf } from "../words/quantity.js";
import { Table } from "./table.js";

const USES = { fit: t`fitted`, holdout: t`held out` };

/**
 * A table for each set of runs: neither errors nor evidence compare between them.
 * @param {{ study: any, lines: import("../words/ledger.js").LedgerLine[] }} properties
 */
export function Ledger({ study, lines }) {
  const sets = dataSets(lines);
  return html`
    ${sets.map(
      (set) => html`
        ${sets.length > 1 && html`<h3>${runWords(set[0].line)}</h3>`}
        <${SetLedger}
          study=${study}
          lines=${set}
          label=${sets.length > 1 ? t`Error ledger, ${runWords(set[0].line)}` : t`Error ledger`}
        />
      `,
    )}
  `;
}

/**
 * @param {{ study: any, lines: import("../words/ledger.js").LedgerLine[], label: string }} properties
 */
function SetLedger({ study, lines, label }) {
  const channels = CHANNELS.filter((channel) => lines.some(({ line }) => line.error.fit[channel]));
  const head = [
    t`model`,
    t`runs`,
    ...channels.map((c) => titled(short(c), shown(unitOf(c)).unit)),
    t`noise sds`,
    t`in 90 % interval`,
    t`ln evidence`,
  ];
  const row = (
    /** @type {string} */ name,
    /** @type {"fit" | "holdout"} */ use,
    /** @type {any} */ error,
    /** @type {number | null | undefined} */ inside,
    evidence = "",
  ) => [
    name,
    USES[use],
    ...channels.map((c) => (error[c] ? errorWords(error[c].rmse * shown(unitOf(c)).scale) : "–")),
    errorWords(error.all.rmse_fixed_sigma ?? error.all.rmse_sigma),
    inside === null || inside === undefined ? "–" : `${Math.round(100 * inside)} %`,
    evidence,
  ];
  const rows = lines.flatMap(({ name, line }) =>
    /** @type {const} */ (["fit", "holdout"])
      .filter((use) => line.error[use])
      .map((use) => {
        const evidence = use === "fit" && line.log_evidence !== null ? minus(line.log_evidence.toFixed(1)) : "";
        return row(use === "fit" ? name : "", use, line.error[use], line.coverage90?.[use], evidence);
      }),
  );
  const besides = beside(study, lines).filter(([, of]) => of?.holdout);
  for (const [name, of] of besides) rows.push(row(name, "holdout", of.holdout, of.coverage90?.holdout));
  const isByWidth = lines.some(({ line }) =>
    /** @type {const} */ (["fit", "holdout"]).some((use) => isInsideByWidth(line.error[use], line.coverage90?.[use])),
  );
  return html`
    <${Table} label=${label} head=${head} rows=${rows} numbers=${head.map((_, k) => k).filter((k) => k > 1)} />
    ${besides.length > 0 && html`<p class="note">${besides.map(([, , words]) => words).join(" ")}</p>`}
    ${
      isByWidth &&
      html`
        <p class="note">
          ${t`In 90 % interval: the intervals are as wide as the error, so this share does not support the model.`}
        </p>
      `
    }
  `;
}

/** The errors in noise standard deviations above which intervals of that noise would hold few of the measurements. */
const LARGE = 3;

/** Whether the intervals hold every measurement although the errors are large: they are much wider than the noise. */
function isInsideByWidth(/** @type {any} */ error, /** @type {number | null | undefined} */ inside) {
  return Boolean(error) && inside === 1 && (error.all.rmse_fixed_sigma ?? 0) > LARGE;
}

/** What predicts held-out runs beside the models as they are, among the lines with the current model; what it is. */
function beside(/** @type {any} */ study, /** @type {any[]} */ lines) {
  const current = lines.find((own) => own.id === study.current)?.line;
  const combined = current && study.combined?.models > 1 ? study.combined : null;
  return /** @type {[string, any, string][]} */ ([
    [
      t`current, corrected`,
      current?.corrected,
      t`Current, corrected: the current model and what it misses at the fitted conditions, interpolated.`,
    ],
    [
      t`all, combined`,
      combined,
      t`All, combined: the corrected models together, weighed by how well each predicts the fitted runs.`,
    ],
    [
      t`interpolation`,
      current?.baseline,
      t`Interpolation: the fitted measurements without any model, extrapolated beyond them, on the runs where that is
        possible.`,
    ],
  ]);
}
