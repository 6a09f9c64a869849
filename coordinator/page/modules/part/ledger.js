// The error ledger as a table.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { dataSets, runWords } from "../words/ledger.js";
import { CHANNELS, errorWords, minus, short, shown, titled, unitOf } from "../words/quantity.js";
import { Table } from "./table.js";

/** @typedef {import("../words/ledger.js").LedgerLine} LedgerLine */

const USES = { fit: t`fitted`, holdout: t`held out` };
const BOTH = /** @type {const} */ (["fit", "holdout"]);
/** @type {Record<string, string>} */
const GROUPS = {
  in_levels: t`in levels`,
  between_levels: t`between levels`,
  beyond: t`beyond`,
  not_steady: t`not steady`,
};

/**
 * A table for each set of runs: neither errors nor evidence compare between them.
 * @param {{ study: Study, lines: LedgerLine[] }} properties
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
 * @param {{ study: Study, lines: LedgerLine[], label: string }} properties
 */
function SetLedger({ study, lines, label }) {
  const channels = CHANNELS.filter((channel) => lines.some(({ line }) => line.error.fit?.[channel]));
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
    /** @type {string} */ runs,
    /** @type {ErrorTable | null | undefined} */ error,
    /** @type {number | null | undefined} */ inside,
    evidence = "",
  ) => [
    name,
    runs,
    ...channels.map((c) => {
      const ofChannel = error?.[c];
      return ofChannel ? errorWords(ofChannel.rmse * shown(unitOf(c)).scale) : "–";
    }),
    errorWords(error?.all.rmse_fixed_sigma ?? error?.all.rmse_sigma),
    inside === null || inside === undefined ? "–" : `${Math.round(100 * inside)} %`,
    evidence,
  ];
  const groupRows = (/** @type {HoldoutGroup[] | undefined} */ groups) =>
    several(groups).map((group) => row("", `${GROUPS[group.name]} (${group.runs})`, group.error, group.coverage90));
  const rows = lines.flatMap(({ name, line }) =>
    BOTH.flatMap((use) => {
      const error = line.error[use];
      if (!error) return [];
      const evidence =
        use === "fit" && typeof line.log_evidence === "number" ? minus(line.log_evidence.toFixed(1)) : "";
      const ofUse = row(use === "fit" ? name : "", USES[use], error, line.coverage90[use], evidence);
      return use === "fit" ? [ofUse] : [ofUse, ...groupRows(line.holdout_groups)];
    }),
  );
  const besides = beside(study, lines).filter(({ holdout }) => holdout);
  for (const { name, holdout, inside, groups } of besides)
    rows.push(row(name, USES.holdout, holdout, inside), ...groupRows(groups));
  const isGrouped = lines.some(({ line }) => several(line.holdout_groups).length > 0);
  const isByWidth = lines.some(({ line }) =>
    BOTH.some((use) => isInsideByWidth(line.error[use], line.coverage90[use])),
  );
  return html`
    <${Table} label=${label} head=${head} rows=${rows} numbers=${head.map((_, k) => k).filter((k) => k > 1)} />
    ${
      isGrouped &&
      html`
        <p class="note">
          ${t`Held-out runs, with their number: in levels, each condition is one that was fitted, though perhaps not
            together with the others; between levels, a condition lies between fitted ones; beyond, it lies outside of
            what was fitted, or no fitted run has the wheel or the soil; not steady, the recording shows that the wheel
            still sinks.`}
        </p>
      `
    }
    ${besides.length > 0 && html`<p class="note">${besides.map(({ meaning }) => meaning).join(" ")}</p>`}
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

/** The groups to show: none where all runs are in one. */
const several = (/** @type {HoldoutGroup[] | undefined} */ groups) => (groups && groups.length > 1 ? groups : []);

/** The errors in noise standard deviations above which intervals of that noise would hold few of the measurements. */
const LARGE = 3;

/** Whether the intervals hold every measurement although the errors are large: they are much wider than the noise. */
function isInsideByWidth(
  /** @type {ErrorTable | null | undefined} */ error,
  /** @type {number | null | undefined} */ inside,
) {
  return inside === 1 && (error?.all.rmse_fixed_sigma ?? 0) > LARGE;
}

/** What predicts held-out runs beside the models as they are, among the lines with the current model; what it is. */
function beside(/** @type {Study} */ study, /** @type {LedgerLine[]} */ lines) {
  const current = lines.find((line) => line.id === study.current)?.line;
  const combined = current && study.combined && study.combined.models > 1 ? study.combined : null;
  const corrected = current?.corrected;
  return [
    {
      name: t`current, corrected`,
      holdout: corrected?.holdout,
      inside: corrected?.coverage90.holdout,
      groups: corrected?.holdout_groups,
      meaning: t`Current, corrected: the current model and what it misses at the fitted conditions, interpolated.`,
    },
    {
      name: t`all, combined`,
      holdout: combined?.holdout,
      inside: combined?.coverage90.holdout,
      groups: combined?.holdout_groups,
      meaning: t`All, combined: the corrected models and the measurements alone together, weighed by how well
        each predicts left-out levels of the fitted runs.`,
    },
    {
      name: t`interpolation`,
      holdout: current?.baseline.holdout,
      inside: null,
      groups: current?.baseline.holdout_groups,
      meaning: t`Interpolation: the fitted measurements without any model, extrapolated beyond them, on the runs where
        that is possible.`,
    },
  ];
}
