// The headline of a study: what was found, in one sentence with the error before and after it.

import { t, translated } from "../language/language.js";
import { meanAndSpread, shownParameter } from "./parameter.js";
import { capital, channelName, digits, errorWords, probability, shown, unitOf, words } from "./quantity.js";

/**
 * @typedef {{ channel: string, use: "fit" | "holdout", unit: string, before: number | null, now: number, noise: number
 *   | null }} ErrorChange Root mean square errors in the unit that is shown; before: of the submitted model on the same
 *   runs.
 * @typedef {{ name: string, summary: string, probability: number }} Explanation
 */

/** `8.3 N on held-out runs`: where an error was taken. */
const USES = { fit: t`fitted runs`, holdout: t`held-out runs` };

/** What an explanation says in plain words; its name where there are none. */
function plain(/** @type {{ name: string, summary?: string | null }} */ { name, summary }) {
  if (name === "none") return t`nothing is missing`;
  return summary ? translated(summary) : name === "not_in_library" ? t`a law that is not in the library` : words(name);
}

/**
 * The submitted model, where the shown one has effects that it has not and both were calibrated on the same runs.
 * @param {LedgerEntry[]} ledger
 * @param {number} id of the shown model
 */
export function lineBefore(ledger, id) {
  const now = ledger.find((line) => line.calibration === id);
  const before =
    now &&
    ledger.find(
      (line) =>
        line.data_set === now.data_set && line !== now && line.effects.every((effect) => now.effects.includes(effect)),
    );
  return before && before.effects.length < now.effects.length ? before : null;
}

/**
 * The errors of the shown model, worst first: by what its effects bought where it has any, else over the noise.
 * @param {Study} study
 * @param {ToldModel} model
 * @returns {ErrorChange[]}
 */
export function errorChanges(study, model) {
  const now = study.ledger.find((line) => line.calibration === model.id);
  if (!now) return [];
  const before = lineBefore(study.ledger, model.id);
  const changes = model.story.wrong.channels.flatMap(({ channel, use }) => {
    const error = now.error[use]?.[channel];
    const old = before?.error[use]?.[channel];
    if (!error) return [];
    const { unit, scale } = shown(unitOf(channel));
    const sigma = study.fixed_sigma[channel];
    // A noise that was inferred with the misfit is no measure of it.
    const noise = sigma && sigma.source !== "inferred" ? sigma.sd * scale : null;
    return [
      {
        channel,
        use,
        unit,
        before: old && old.runs === error.runs ? old.rmse * scale : null,
        now: error.rmse * scale,
        noise,
      },
    ];
  });
  const gain = (/** @type {ErrorChange} */ c) => (c.before === null ? 0 : Math.log(c.before / c.now));
  return before ? changes.sort((a, b) => gain(b) - gain(a)) : changes;
}

/** `11.7 → 1.19 N`; a line does not break within it. */
export const changeWords = (/** @type {ErrorChange} */ { before, now, unit }) =>
  `${before === null ? "" : `${errorWords(before)} → `}${errorWords(now)} ${unit}`.replaceAll(" ", "\u00a0");

/** `1.2 N`: the noise beside an error. */
const noiseWords = (/** @type {ErrorChange} */ { noise, unit }) =>
  `${digits(noise, 2)} ${unit}`.replaceAll(" ", "\u00a0");

/**
 * The headline of a model.
 * @param {Pick<ToldModel, "story">} model
 * @param {ErrorChange[]} changes
 */
export function headline({ story }, changes) {
  const { missing, wrong } = story;
  const [first] = changes;
  const error = first && t`${channelName(first.channel)} of ${USES[first.use]}: error ${changeWords(first)}`;
  const beside = first && first.noise !== null ? t`, noise ${noiseWords(first)}` : "";
  const added = missing.already_added;
  const isCalm = wrong.channels.length > 0 && wrong.channels.every((c) => c.is_within_noise);
  if (added.length > 0 && first?.before != null) {
    const bought =
      added.length === 1 ? t`${error} with one more effect` : t`${error} with ${added.length} more effects`;
    if (["named", "class", "not_in_library"].includes(missing.verdict ?? ""))
      return capital(t`${bought}; more is missing`);
    return capital(missing.verdict === "undecided" ? t`${bought}; what else is missing is undecided` : bought);
  }
  const found = {
    named: () => t`something is missing: ${missing.named.map(plain).join("; ")}`,
    class: () => t`one of ${missing.named.length} effects is missing, and the data do not tell which`,
    none: null,
    not_in_library: () => t`an effect is missing that the library does not have`,
    undecided: () => t`whether something is missing is undecided`,
    nothing_detectable: () =>
      isCalm ? t`the model explains the runs to within the noise` : t`nothing is missing that these data can show`,
  }[missing.verdict ?? "none"];
  if (!found && !isCalm && first) {
    const noise = first.noise === null ? "" : t` (noise ${noiseWords(first)})`;
    const error = changeWords({ ...first, before: null });
    return capital(
      t`${channelName(first.channel)} of ${USES[first.use]} is off by ${error}${noise}; what is missing was not searched
        for`,
    );
  }
  const verdict = found
    ? found()
    : isCalm
      ? t`the model explains the runs to within the noise`
      : t`the model was not searched for a missing effect`;
  return capital(error ? t`${verdict} (${error}${beside})` : verdict);
}

/**
 * The explanations to draw as bars: of an effect that was added and its rivals, else of the search; the last is all
 * others together.
 * @param {Pick<Story["missing"], "already_added" | "leading">} missing
 * @returns {Explanation[]}
 */
export function explanations({ already_added: added, leading }) {
  const judged = added.flatMap(({ probability, ...effect }) =>
    probability === null || probability === undefined ? [] : [{ ...effect, probability }],
  );
  const all = judged.length > 0 ? judged.flatMap((effect) => [effect, ...effect.rivals]) : leading;
  const named = all.map((effect) => ({
    name: effect.name,
    summary: plain(effect),
    probability: effect.probability,
  }));
  // Each of several effects was found by a separate search, so their probabilities do not sum to one.
  const rest = 1 - named.reduce((sum, explanation) => sum + explanation.probability, 0);
  return judged.length > 1 || rest < 1e-9 || named.length === 0
    ? named
    : [...named, { name: "", summary: t`all other explanations together`, probability: rest }];
}

/** `shear modulus 9.4 ± 0.6 mm`: the parameters of an added effect. */
export function strengthWords(/** @type {Pick<Schemas["AddedEffect"], "strengths">} */ { strengths }) {
  return strengths
    .map(({ name, unit, mean, sd }) => {
      const called = shownParameter({ name: name.split(".").slice(1).join(".") || name, unit });
      return `${called.name} ${meanAndSpread(called, mean, sd)}${called.unit === "" ? "" : ` ${called.unit}`}`;
    })
    .join(", ");
}

/** The probability of an explanation in words. */
export const probabilityWords = (/** @type {Explanation} */ { probability: p }) => `P ${probability(p)}`;
