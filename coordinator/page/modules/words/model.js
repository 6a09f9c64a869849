// The models of a study, and their names.

import { t } from "../language/language.js";

/** The models of a study that have results: everything but searches. */
export const models = (/** @type {any} */ study) => study.members.filter((/** @type {any} */ m) => m.kind !== "search");

/** The model that is shown: the one that the address names, or the current one, or the first. */
export function modelOf(/** @type {any} */ study, /** @type {number | null} */ asked) {
  const finished = models(study).filter((/** @type {any} */ m) => m.state === "finished");
  const named =
    finished.find((/** @type {any} */ m) => m.id === asked) ??
    finished.find((/** @type {any} */ m) => m.id === study.current);
  return named ?? finished[0] ?? null;
}

/**
 * The name of a model of a study: that of the comparison where the job compares it; else what it has beyond the
 * submitted job, with the number of its runs where it was calibrated on others; and, where another has the same, the
 * number of its calibration.
 */
export function modelName(/** @type {any} */ study, /** @type {any} */ member) {
  const compared = study.models?.models.find((/** @type {any} */ m) => m.calibration === member.id);
  if (compared) return compared.name;
  const name = (/** @type {any} */ m) =>
    [m.effects.length === 0 ? t`base` : t`with ${m.effects.join(", ")}`, ...otherRuns(study, m)].join(", ");
  const isShared = models(study).filter((/** @type {any} */ m) => name(m) === name(member)).length > 1;
  return isShared ? t`${name(member)} (calibration ${member.id})` : name(member);
}

/** How many runs a model was fitted to, where these are not those of the submitted job. */
function otherRuns(/** @type {any} */ study, /** @type {any} */ member) {
  const line = study.ledger.find((/** @type {any} */ l) => l.calibration === member.id);
  return line && line.data_set !== 1
    ? [line.fitted_runs === 1 ? t`1 fitted run` : t`${line.fitted_runs} fitted runs`]
    : [];
}
