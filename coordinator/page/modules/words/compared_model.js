// The models that a job compares, as the words of a table.

import { t } from "../language/language.js";
import { CHANNELS, digits, errorWords, minus, probability, short, shown, titled, unitOf } from "./quantity.js";

/** Names in the order of falling evidence; a model without evidence comes last. */
const byEvidence = (/** @type {ComparedModel} */ a, /** @type {ComparedModel} */ b) =>
  (b.log_evidence ?? -Infinity) - (a.log_evidence ?? -Infinity);

/**
 * Head and rows of the comparison, the most probable model first.
 * @param {ModelComparison} comparison the `models` of a study
 * @returns {{ head: string[], rows: string[][] }}
 */
export function comparedModels(comparison) {
  const channels = CHANNELS.filter((channel) => comparison.models.some((m) => m.left_out?.[channel]));
  const head = [
    t`model`,
    t`ln evidence`,
    t`probability`,
    t`p of chi-square`,
    ...channels.map((c) => titled(short(c), shown(unitOf(c)).unit)),
    t`noise sds`,
    t`answer`,
  ];
  const rows = [...comparison.models]
    .sort(byEvidence)
    .map((model) => [
      model.name,
      evidence(model),
      probability(model.probability),
      typeof model.chi_square_p === "number" ? probability(model.chi_square_p) : "–",
      ...channels.map((c) => (model.left_out?.[c] ? errorWords(model.left_out[c].rmse * shown(unitOf(c)).scale) : "–")),
      errorWords(model.left_out?.all.rmse_fixed_sigma),
      answer(comparison, model),
    ]);
  return { head, rows };
}

/** Log-evidence and its standard error, both to the second digit of the error. */
function evidence(/** @type {ComparedModel} */ { log_evidence: log, log_evidence_se: se }) {
  if (log === null || log === undefined) return "–";
  if (!se || se < 0) return minus(log.toFixed(1));
  const decimals = Math.max(0, 1 - Math.floor(Math.log10(se)));
  return `${minus(log.toFixed(decimals))} ± ${minus(se.toFixed(decimals))}`;
}

/** What is decided about a model. */
function answer(/** @type {ModelComparison} */ comparison, /** @type {ComparedModel} */ model) {
  const best = comparison.models.find((m) => m.calibration === comparison.best);
  const decided =
    model !== best
      ? behind(best, model)
      : comparison.none_of_these
        ? t`most probable, yet none of these`
        : comparison.none_of_these === false
          ? t`chosen`
          : t`chosen; none of these cannot be said`;
  return model.calibration === comparison.best_predicting ? t`${decided}; predicts best` : decided;
}

/** How far a model stays behind the best one. */
function behind(/** @type {ComparedModel | undefined} */ best, /** @type {ComparedModel} */ model) {
  const [highest, lower] = [best?.log_evidence, model.log_evidence];
  if (typeof highest !== "number" || typeof lower !== "number") return t`no evidence`;
  return t`${digits(highest - lower)} nats less`;
}

/** Which data the errors are of. */
export const leftOutWords = (/** @type {ModelComparison} */ comparison) =>
  comparison.models.some((m) => m.left_out_by === "holdout")
    ? t`Errors are of the held-out runs, which are never fitted`
    : t`No runs are held out: errors are of each condition, predicted from the others by weighting the draws, exact
      enough to rank models alone`;
