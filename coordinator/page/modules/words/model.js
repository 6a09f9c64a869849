// The models of a study, and their names.

import { t } from "../language/language.js";

/** The models of a study that have results: everything but searches. */
export const models = (/** @type {Study} */ study) => study.members.filter((m) => m.kind !== "search");

/** The model that is shown: the one that the address names, or the current one, or the first. */
export function modelOf(/** @type {Study} */ study, /** @type {number | null} */ asked) {
  const finished = models(study).filter((m) => m.state === "finished");
  const named = finished.find((m) => m.id === asked) ?? finished.find((m) => m.id === study.current);
  return named ?? finished[0] ?? null;
}

/**
 * The name of a model of a study: that of the comparison where the job compares it; else what it has beyond the
 * submitted job, with the number of its runs where it was calibrated on others; and, where another has the same, the
 * number of its calibration.
 */
export function modelName(/** @type {Study} */ study, /** @type {Member} */ member) {
  const compared = study.models?.models.find((m) => m.calibration === member.id);
  if (compared) return compared.name;
  const name = (/** @type {Member} */ m) =>
    [m.effects.length === 0 ? t`base` : t`with ${m.effects.join(", ")}`, ...otherRuns(study, m)].join(", ");
  const isShared = models(study).filter((m) => name(m) === name(member)).length > 1;
  return isShared ? t`${name(member)} (calibration ${member.id})` : name(member);
}

/** How many runs a model was fitted to, where these are not those of the submitted job. */
function otherRuns(/** @type {Study} */ study, /** @type {Member} */ member) {
  const line = study.ledger.find((l) => l.calibration === member.id);
  return line && line.data_set !== 1
    ? [line.fitted_runs === 1 ? t`1 fitted run` : t`${line.fitted_runs} fitted runs`]
    : [];
}

/**
 * The model that a campaign goes on from: the member that is shown, else the model that is. A search and a fit have no
 * posterior that further runs could change.
 * @param {Member} member
 * @param {Member | null} model
 */
export const followable = (member, model) =>
  [member, model].find((candidate) => candidate?.kind === "sample" && candidate.state === "finished") ?? null;
