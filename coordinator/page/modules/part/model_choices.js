// The form that chooses models, priors and effects by their meaning, and the search that follows the calibration.

import { html, useState } from "../html.js";
import { t, translated } from "../language/language.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import * as template from "../template.js";
import { numberOf, parameterName, words } from "../words/quantity.js";

/** @typedef {{ form: string, texts: [string, string] }} TypedPrior */
/**
 * @typedef {{ models: string[], changed: Record<string, TypedPrior>, effects: string[], search: string }} Choices
 *   changed: priors by name, where somebody typed another
 */

/** Models that can be compared: the other one takes a thousand times as long. */
const ALONE = "scm";

/** How many numbers a form has. */
const count = (/** @type {string} */ form) => (form === "fixed" ? 1 : 2);

/** The numbers of a prior that somebody typed; null where one is missing, or no prior has them. */
function numbersOf(/** @type {TypedPrior} */ { form, texts }) {
  const numbers = texts.slice(0, count(form)).map(numberOf);
  if (numbers.some((number) => number === null)) return null;
  const [a, b = 0] = /** @type {number[]} */ (numbers);
  const isGood = form === "fixed" || (form === "normal" ? b > 0 : a < b && (form !== "loguniform" || a > 0));
  return isGood ? /** @type {[number, number]} */ ([a, b]) : null;
}

/**
 * The proposed priors of the chosen models and of these wheels; a radius is typed elsewhere, so that its numbers are
 * NaN.
 */
const shownPriors = (/** @type {Choices} */ { models }, /** @type {string[]} */ wheels) =>
  template
    .priorsOf(wheels.map((name) => ({ name, radiusMm: NaN })))
    .filter(({ of }) => of.some((kind) => models.includes(kind)));

/** What is wrong with the priors that somebody typed, of those that are shown: the job has no others. */
export function badPriors(/** @type {Choices} */ choices, /** @type {string[]} */ wheels) {
  return shownPriors(choices, wheels)
    .map(({ name }) => ({ name, typed: choices.changed[name] }))
    .filter(({ typed }) => typed && numbersOf(typed) === null)
    .map(({ name, typed }) =>
      typed.form === "loguniform"
        ? t`prior of ${words(name)}: two numbers above 0, the smaller first`
        : t`prior of ${words(name)}: two numbers, the smaller first, or a mean and an sd above 0, or one number`,
    );
}

/** The priors of a job: those of dry sands, and those that somebody typed in their place. */
export function priorsOf(
  /** @type {Choices} */ { changed },
  /** @type {{ name: string, radiusMm: number }[]} */ wheels,
) {
  return template.priorsOf(wheels).map((prior) => {
    const typed = changed[prior.name];
    const numbers = typed && numbersOf(typed);
    return numbers
      ? {
          ...prior,
          form: typed.form,
          numbers,
          bounds: typed.form === "normal" && prior.form === "normal" ? prior.bounds : null,
        }
      : prior;
  });
}

/** @param {{ choices: Choices, wheels: string[], change: (choices: Choices) => void }} properties */
export function ModelChoices({ choices, wheels, change }) {
  const { models, effects, search } = choices;
  const flip = (/** @type {string} */ kind) => {
    const others = models.filter((one) => one !== kind);
    if (others.length < models.length) return change({ ...choices, models: others });
    const beside = kind === ALONE ? [] : others.filter((one) => one !== ALONE);
    return change({
      ...choices,
      models: template.MODELS.map(([name]) => name).filter((name) => name === kind || beside.includes(name)),
    });
  };
  return html`
    <h3>What is computed</h3>
    <fieldset class="choices">
      <legend>Models: several are compared by their evidence</legend>
      ${template.MODELS.map(
        ([kind, meaning]) =>
          html`
            <label>
              <input type="checkbox" checked=${models.includes(kind)} onChange=${() => flip(kind)} />${" "}
              <b>${kind}</b> <span class="note">${meaning}</span>
            </label>
          `,
      )}
    </fieldset>
    <details>
      <summary>Priors: those of dry sands</summary>
      <${Priors} choices=${choices} wheels=${wheels} change=${change} />
    </details>
    <${Effects}
      effects=${effects}
      change=${(/** @type {string[]} */ chosen) => change({ ...choices, effects: chosen })}
    />
    <p>
      <label>
        After the
        calibration <select
          value=${search}
          onChange=${(/** @type {SelectEvent} */ e) => change({ ...choices, search: e.currentTarget.value })}
        >
          ${template.SEARCHES.map(
            ([name, meaning]) => html`<option value=${name} selected=${name === search}>${meaning}</option>`,
          )}
        </select>
      </label>
    </p>
  `;
}

/**
 * The priors of the chosen models, each with its form and its numbers.
 * @param {{ choices: Choices, wheels: string[], change: (choices: Choices) => void }} properties
 */
function Priors({ choices, wheels, change }) {
  // The radius of a wheel is typed above: its prior goes from there to 1.24 times as much.
  const rows = shownPriors(choices, wheels);
  const set = (/** @type {string} */ name, /** @type {TypedPrior} */ typed) =>
    change({ ...choices, changed: { ...choices.changed, [name]: typed } });
  return html`
    <p class="note">A prior says what is known before the runs. job.toml takes other forms, too.</p>
    ${rows.map((prior) => {
      const isRadius = Number.isNaN(prior.numbers[0]);
      const typed = choices.changed[prior.name] ?? {
        form: prior.form,
        texts: /** @type {[string, string]} */ (isRadius ? ["", ""] : prior.numbers.map(String)),
      };
      const forms = template.FORMS.some(([form]) => form === prior.form)
        ? template.FORMS
        : [...template.FORMS, [prior.form, t`between … and …, even in the logarithm`]];
      const called = parameterName(prior.name, prior.unit);
      return html`
        <div class="actions prior" role="group" aria-label=${t`prior of ${called}`}>
          <span><b>${called}</b> <span class="note">${prior.meaning}</span></span>
          <select
            aria-label=${t`form of the prior of ${called}`}
            onChange=${(/** @type {SelectEvent} */ e) => set(prior.name, { ...typed, form: e.currentTarget.value })}
          >
            ${forms.map(
              ([form, meaning]) => html`<option value=${form} selected=${form === typed.form}>${meaning}</option>`,
            )}
          </select>
          ${typed.texts.slice(0, count(typed.form)).map(
            (text, k) => html`
              <input
                size="8"
                inputmode="decimal"
                aria-label=${t`number ${k + 1} of the prior of ${called}`}
                placeholder=${isRadius ? [t`radius`, t`1.24 × radius`][k] : ""}
                value=${text}
                onInput=${(/** @type {FieldEvent} */ e) =>
                  set(prior.name, {
                    ...typed,
                    texts: /** @type {[string, string]} */ (
                      typed.texts.map((old, i) => (i === k ? e.currentTarget.value : old))
                    ),
                  })}
              />
            `,
          )}
          ${
            choices.changed[prior.name] &&
            html`
              <button
                type="button"
                onClick=${() =>
                  change({
                    ...choices,
                    changed: Object.fromEntries(
                      Object.entries(choices.changed).filter(([name]) => name !== prior.name),
                    ),
                  })}
              >
                As proposed
              </button>
            `
          }
        </div>
      `;
    })}
  `;
}

/** Effects of the catalogue that the model has from the start. */
function Effects(/** @type {{ effects: string[], change: (effects: string[]) => void }} */ { effects, change }) {
  const [isOpen, setOpen] = useState(false);
  const { answer: catalogue } = useAnswer(isOpen ? path.effects : null);
  const flip = (/** @type {string} */ name) =>
    change(effects.includes(name) ? effects.filter((one) => one !== name) : [...effects, name]);
  return html`
    <details onToggle=${(/** @type {DetailsEvent} */ e) => setOpen(e.currentTarget.open)}>
      <summary>
        ${
          effects.length === 0
            ? t`Effects from the start: none; the search tries all of them`
            : t`Effects from the start: ${effects.map(words).join(", ")}`
        }
      </summary>
      <div class="choices many" tabindex="0" role="region" aria-label="Effects of the catalogue">
        ${(catalogue ?? []).map(
          (effect) =>
            html`
              <label key=${effect.name}>
                <input
                  type="checkbox"
                  checked=${effects.includes(effect.name)}
                  onChange=${() => flip(effect.name)}
                />${" "}
                <b>${words(effect.name)}</b> <span class="note">${translated(effect.summary)}</span>
              </label>
            `,
        )}
      </div>
    </details>
  `;
}
