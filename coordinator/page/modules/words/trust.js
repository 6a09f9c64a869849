// How far to trust a calibration, in one line for each question: the sampler, the data, the priors, the predictions.

import { t } from "../language/language.js";
import { shownParameter } from "./parameter.js";
import { channelName, digits } from "./quantity.js";

/** A probability below which chance does not explain what is seen. */
const LEVEL = 0.01;
/** Data that narrow a prior by less than this share of its sd tell little. */
const LITTLE = 0.1;
/** Errors larger than this many times the noise are more than the noise: what the model misses is in them. */
const MOST_TIMES = 2;

/** @typedef {{ question: string, level: "good" | "fair" | "poor", text: string }} Judgement */

const named = (/** @type {{ name: string, unit: string }} */ parameter) => shownParameter(parameter).name;

/** `a, b and c`, of many the first. */
function list(/** @type {string[]} */ names) {
  if (names.length > 4) return t`${names.slice(0, 3).join(", ")} and ${names.length - 3} more`;
  return names.length < 2 ? names.join("") : t`${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;
}

/**
 * @param {LedgerEntry | undefined} line of the error ledger; none of a fit without a posterior
 * @param {Pick<Diagnostics, "channels" | "parameters">} diagnostics
 * @param {Pick<Story["wrong"], "channels">} wrong of the story
 * @returns {Judgement[]}
 */
export function judgements(line, diagnostics, wrong) {
  return [
    sampler(line),
    residuals(diagnostics, wrong),
    priors(diagnostics),
    informed(diagnostics),
    predictions(wrong),
  ].filter((judgement) => judgement !== null);
}

/** @returns {Judgement | null} */
function sampler(/** @type {LedgerEntry | undefined} */ line) {
  if (!line || line.equilibrated === null || line.equilibrated === undefined) return null;
  const question = t`Did the sampler arrive?`;
  return line.equilibrated
    ? { question, level: "good", text: t`each stage reached equilibrium: the draws represent the posterior` }
    : { question, level: "poor", text: t`a stage did not reach equilibrium: allow more moves` };
}

/** @returns {Judgement | null} */
function residuals(
  /** @type {Pick<Diagnostics, "channels">} */ { channels },
  /** @type {Pick<Story["wrong"], "channels">} */ wrong,
) {
  const judged = channels.flatMap(({ channel, chi_square: test, error_sd }) =>
    typeof test?.p === "number" ? [{ channel, p: test.p, times: (error_sd ?? NaN) / noiseOf(wrong, channel) }] : [],
  );
  if (judged.length === 0) return null;
  const question = t`Do the assumed errors explain the residuals?`;
  const beyond = judged.filter(({ p }) => p < LEVEL).map((c) => channelName(c.channel));
  // Errors that are inferred from the residuals explain them in any case.
  const widened = judged.filter(({ times }) => times > MOST_TIMES);
  if (beyond.length === 0 && widened.length > 0) {
    const times = Math.max(...widened.map((c) => c.times));
    const names = list(widened.map((c) => channelName(c.channel)));
    return {
      question,
      level: "fair",
      text: t`only with errors that are inferred from the residuals themselves, up to ${digits(times, 2)} times the
        noise: ${names}`,
    };
  }
  return beyond.length === 0
    ? { question, level: "good", text: t`in every channel (chi-square)` }
    : { question, level: "poor", text: t`not in ${list(beyond)}: something is missing, or the noise is understated` };
}

/** The noise of a channel, which the errors of the story count in; not a number where it is not known. */
function noiseOf(/** @type {Pick<Story["wrong"], "channels">} */ { channels }, /** @type {string} */ channel) {
  const judged = channels.find((c) => c.channel === channel && c.is_judged);
  return judged?.noise_sds ? judged.rmse / judged.noise_sds : NaN;
}

/** @returns {Judgement} */
function priors(/** @type {Pick<Diagnostics, "parameters">} */ { parameters }) {
  const question = t`Do the data agree with the priors?`;
  const conflict = parameters.filter((q) => (q.conflict_p ?? 1) < LEVEL).map(named);
  const bound = parameters.filter((q) => q.at_bound).map(named);
  if (conflict.length > 0) return { question, level: "poor", text: t`they contradict the prior of ${list(conflict)}` };
  if (bound.length > 0)
    return {
      question,
      level: "fair",
      text:
        bound.length === 1
          ? t`${list(bound)} lies at a bound of the prior: look whether it is meant`
          : t`${list(bound)} lie at a bound of the prior: look whether it is meant`,
    };
  return { question, level: "good", text: t`no parameter is far out in its prior` };
}

/** @returns {Judgement} */
function informed(/** @type {Pick<Diagnostics, "parameters">} */ { parameters }) {
  const question = t`Do the data determine the parameters?`;
  const little = parameters.filter((q) => (q.contraction ?? 1) < LITTLE).map(named);
  return little.length === 0
    ? { question, level: "good", text: t`each is known better than before` }
    : {
        question,
        level: "fair",
        text:
          little.length === 1
            ? t`they tell little of ${list(little)}: its uncertainty is about that of the prior`
            : t`they tell little of ${list(little)}: their uncertainties are about those of the priors`,
      };
}

/** @returns {Judgement | null} */
function predictions(/** @type {Pick<Story["wrong"], "channels">} */ { channels }) {
  if (channels.length === 0) return null;
  const isHeldOut = channels.every((c) => c.use === "holdout");
  const question = isHeldOut
    ? t`Does it predict runs that it has not seen?`
    : t`Does it predict runs that it has not seen? No run was held out.`;
  const beyond = channels.filter((c) => c.is_judged && !c.is_within_noise).map((c) => channelName(c.channel));
  const open = channels.filter((c) => !c.is_judged).map((c) => channelName(c.channel));
  if (beyond.length > 0)
    return {
      question,
      level: "poor",
      text:
        beyond.length === 1
          ? t`${list(beyond)} is off by more than the noise`
          : t`${list(beyond)} are off by more than the noise`,
    };
  if (open.length > 0)
    return { question, level: "fair", text: t`${list(open)} cannot be judged: the noise is inferred with the misfit` };
  return {
    question,
    level: isHeldOut ? "good" : "fair",
    text: isHeldOut ? t`to within the noise` : t`the fitted runs are within the noise; hold some out to know`,
  };
}
