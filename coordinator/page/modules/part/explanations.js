// The explanations of a misfit by falling probability; pointing at one shows what it would change, a click adds it.

import { html, useState } from "../html.js";
import { t, translated } from "../language/language.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { said } from "../words/clauses.js";
import { parameterValue, shownParameter } from "../words/parameter.js";
import { capital, digits, minus, parameterName, probability, words } from "../words/quantity.js";
import { additionOf, TakeBack } from "./take_back.js";
import { few } from "../words/few.js";

/** A fitted parameter below this is 0. */
const ZERO = 1e-12;
/**
 * Number of explanations that are shown at first: the others have hardly any probability, and the charts beside them
 * stay in view.
 */
const FIRST = 8;
const OTHERS = /** @type {Record<string, string>} */ ({
  none: t`nothing is missing`,
  not_in_library: t`a law that is not in the library`,
});

/**
 * @param {{ record: Discovery, unchanged: Set<string>, ghost: string | null, kept: string | null, show: (name: string |
 *   null) => void, keep: (name: string | null) => void, add: ((extension: Schemas["NewExtension"]) => void) | null,
 *   study: Study, model: Member, isBusy: boolean, reload?: () => void }} properties unchanged: the explanations whose
 *   best fit changes no prediction
 */
export function Explanations({ record, unchanged, ghost, kept, show, keep, add, study, model, isBusy, reload }) {
  const [asked, setAsked] = useState(/** @type {string | null} */ (null));
  const titleOf = useTitles(model);
  const [isAll, setAll] = useState(false);
  const effects = isAll ? record.effects : record.effects.slice(0, FIRST);
  const made = new Set(study.members.filter((m) => m.kind !== "search").map((m) => m.effects.join(" ")));
  const isMade = (/** @type {string} */ name) => made.has([...model.effects, name].join(" "));
  const untried = new Map((record.not_tried ?? []).map((e) => [e.name, e.why]));
  const notesOn = (/** @type {JudgedEffect} */ effect) => {
    const like = likeOf(record.effects, effect);
    const isOpen = like.length > 0 ? t`these data cannot tell it from ${few(like)}` : null;
    return [said(untried.get(effect.name) ?? ""), isOpen].filter(Boolean).join("; ");
  };
  return html`
    <div class="scroll" tabindex="0" role="region" aria-label="Explanations">
      <table class="explanations">
        <thead>
          <tr>
            <th scope="col">explanation</th>
            <th scope="col">probability</th>
            <th scope="col" class="number">nats</th>
            <th scope="col">strength</th>
            <td></td>
          </tr>
        </thead>
        <tbody>
          ${effects.map(
            (effect) => html`
              <tr
                key=${effect.name}
                class=${`${effect.name === ghost ? "shown" : ""} ${effect.in_credible_set ? "credible" : ""}`}
                onMouseEnter=${() => show(effect.name)}
                onMouseLeave=${() => show(null)}
              >
                <th scope="row">
                  <button
                    class="plain"
                    type="button"
                    onFocus=${() => show(effect.name)}
                    onBlur=${() => show(null)}
                    onClick=${() => keep(kept === effect.name ? null : effect.name)}
                    aria-pressed=${kept === effect.name}
                    aria-label=${t`${titleOf(effect.name)}: show what ${OTHERS[effect.name] ?? effect.name} would
                      change`}
                  >
                    <b>${titleOf(effect.name)}</b>
                  </button>
                  <span class="note">
                    ${effect.name in OTHERS ? null : html`<code>${effect.name}</code>`} ${notesOn(effect)}
                  </span>
                </th>
                <td>
                  <span class="bar"><i style=${{ width: `${(100 * effect.probability).toFixed(1)}%` }}></i></span>${" "}
                  <span class="number">${probability(effect.probability)}</span>
                </td>
                <td class="number">${nats(effect.log_bayes_factor)}</td>
                <td>
                  ${
                    isAbsent(effect)
                      ? html`<span class="note">absent: alone, the best fit does without it</span>`
                      : unchanged.has(effect.name)
                        ? html`
                            <span class="note">
                              absent: its best fit changes no prediction by a tenth of its error sd
                            </span>
                          `
                        : Object.entries(effect.parameters).map(
                            ([name, value]) => html`<div>${strength(name, value, effect.units?.[name])}</div>`,
                          )
                  }
                  ${
                    typeof effect.prior_sds === "number" && Math.abs(effect.prior_sds) > 2
                      ? html`<span class="note">${digits(effect.prior_sds, 2)} sds out in its prior</span>`
                      : null
                  }
                </td>
                <td>
                  ${
                    add &&
                    !(effect.name in OTHERS) &&
                    !untried.has(effect.name) &&
                    (isMade(effect.name)
                      ? html`
                          <span class="note">added</span>${" "}
                          <${TakeBack}
                            study=${study}
                            id=${additionOf(study, [...model.effects, effect.name])}
                            reload=${reload}
                          />
                        `
                      : asked === effect.name
                        ? html`
                            <div>Calibrate again with it?</div>
                            <button
                              class="main"
                              type="button"
                              disabled=${isBusy}
                              onClick=${() => add(extension(effect.name, record))}
                            >
                              Add it
                            </button>${" "}
                            <button type="button" onClick=${() => setAsked(null)}>Not now</button>
                          `
                        : html`
                            <button
                              type="button"
                              disabled=${isBusy}
                              onClick=${() => setAsked(effect.name)}
                              aria-label=${t`add ${effect.name}`}
                            >
                              Add
                            </button>
                          `)
                  }
                </td>
              </tr>
            `,
          )}
        </tbody>
      </table>
    </div>
    ${
      record.effects.length > FIRST &&
      html`
        <button type="button" onClick=${() => setAll(!isAll)}>
          ${isAll ? t`Show fewer` : t`Show all ${record.effects.length}`}
        </button>
      `
    }
    <p class="note">
      Nats: log evidence over that of the model as it is. Bold lines: the classes of explanations that have 95 % of the
      probability together; these data cannot tell the members of a class apart. Half of the prior probability is on
      “nothing is missing”.${
        add &&
        t` Add calibrates a further model with the effect; this one stays as it is, and what was added can be taken
          back.`
      }
    </p>
  `;
}

/** What an explanation says, by its name: `Shear stress needs displacement along the rim to build up`. */
export function useTitles(/** @type {Member | undefined} */ model) {
  const { answer: catalogue } = useAnswer(path.effects);
  const summaries = new Map((catalogue ?? []).map((e) => [e.name, e.summary]));
  const told = new Map((model?.story?.missing.leading ?? []).map((e) => [e.name, e.summary]));
  // A report carries the story, and no catalogue.
  const summaryOf = (/** @type {string} */ name) => summaries.get(name.split(".")[0]) ?? told.get(name);
  return (/** @type {string} */ name) => capital(OTHERS[name] ?? translated(summaryOf(name) ?? words(name)));
}

/** Nats to a digit after the point, without a sign before 0. */
const nats = (/** @type {number} */ value) => minus(value.toFixed(1).replace(/^-(?=0\.0$)/, ""));

/** Whether the best fit leaves an effect out: its parameters are 0. */
const isAbsent = (/** @type {JudgedEffect} */ { parameters }) =>
  Object.keys(parameters).length > 0 && Object.values(parameters).every((value) => Math.abs(value) < ZERO);

/** A fitted parameter in its unit; records of earlier versions do not state it. */
function strength(/** @type {string} */ name, /** @type {number} */ value, /** @type {string | undefined} */ stated) {
  const parameter = name.split(".").slice(1).join(".") || name;
  if (stated === undefined) return `${parameterName(parameter, null)} ${digits(value)} (SI)`;
  const called = { name: parameter, unit: stated };
  return `${shownParameter(called).name} ${parameterValue(called, value)}`;
}

/** Explanations of a class whose evidence differs by more than this are told apart by it [nats]. */
const ALIKE = 3;

/** @typedef {Pick<JudgedEffect, "name" | "class" | "log_bayes_factor">} Judged */

/** The explanations that the data cannot tell from one: of its class, and alike in evidence. */
export function likeOf(/** @type {Judged[]} */ effects, /** @type {Judged} */ effect) {
  const isLike = (/** @type {Judged} */ other) =>
    other.class === effect.class &&
    other.name !== effect.name &&
    Math.abs(other.log_bayes_factor - effect.log_bayes_factor) <= ALIKE;
  return effects.filter(isLike).map((other) => other.name);
}

/** What is sent to add an effect; `EFFECT.WHEEL` acts on one wheel. */
function extension(/** @type {string} */ name, /** @type {Discovery} */ record) {
  const named = record.extension;
  if (named && "on_wheel" in named && `${named.on_wheel.effect}.${named.on_wheel.wheel}` === name)
    return named.on_wheel;
  const [effect, wheel] = name.split(".");
  return wheel ? { effect, wheel } : { effect };
}
