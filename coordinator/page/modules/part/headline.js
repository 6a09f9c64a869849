// The first thing of a study: its headline, the errors before and after, the explanations by probability, and the
// picture that shows it.

import { html } from "../html.js";
import { t, translated } from "../language/language.js";
import { isReport } from "../rest/answers.js";
import {
  changeWords,
  errorChanges,
  explanations,
  headline,
  probabilityWords,
  strengthWords,
} from "../words/headline.js";
import { capital, channelName, digits, words } from "../words/quantity.js";
import { BeforeAfter } from "./before_after.js";
import { isAddition, TakeBack } from "./take_back.js";

const USES = { fit: t`fitted runs`, holdout: t`held-out runs` };

/** @param {{ study: Study, model: ToldModel, reload?: () => void }} properties */
export function Headline({ study, model, reload }) {
  const changes = errorChanges(study, model);
  const bars = explanations(model.story.missing);
  return html`
    <section class="headline" aria-label="What was found">
      <div>
        <h2>${headline(model, changes)}.</h2>
        ${model.story.missing.already_added.map((effect) => html`<${Added} key=${effect.name} effect=${effect} />`)}
        ${changes.length > 0 && html`<${Errors} changes=${changes} />`}
        ${
          bars.length > 0 &&
          html`
            <h3>How probable each explanation is</h3>
            <ul class="bars">
              ${bars.map(
                (bar) => html`
                  <li key=${bar.name}>
                    <span class="bar"><i style=${{ width: `${(100 * bar.probability).toFixed(1)}%` }}></i></span>
                    <span class="number">${probabilityWords(bar)}</span>
                    <span>
                      ${bar.summary}${" "}
                      ${
                        bar.name && !["none", "not_in_library"].includes(bar.name)
                          ? html`<code class="note">${bar.name}</code>`
                          : null
                      }
                    </span>
                  </li>
                `,
              )}
            </ul>
          `
        }
        ${
          !isReport &&
          isAddition(study, model) &&
          html`
            <p>
              <${TakeBack} study=${study} id=${model.id} label=${t`Take back what was added last`} reload=${reload} />
            </p>
          `
        }
      </div>
      ${
        changes.length > 0 &&
        html`<div><${BeforeAfter} study=${study} model=${model} channel=${changes[0].channel} /></div>`
      }
    </section>
  `;
}

/** An effect that was added, in plain words, with its strength. */
function Added(/** @type {{ effect: Schemas["AddedEffect"] }} */ { effect }) {
  const strength = strengthWords(effect);
  return html`
    <p>
      Added: <b>${effect.summary ? translated(effect.summary) : words(effect.name)}</b>
      ${strength && `, ${strength}`} <code class="note">${effect.name}</code>
    </p>
  `;
}

/** The error of each channel before and after, beside the noise. */
function Errors(/** @type {{ changes: import("../words/headline.js").ErrorChange[] }} */ { changes }) {
  const uses = [...new Set(changes.map(({ use }) => USES[use]))];
  return html`
    <table class="errors" aria-label="Errors">
      <thead>
        <tr>
          <th scope="col">error on ${uses.join(t` or `)}</th>
          <th scope="col" class="number">${changes.some((c) => c.before !== null) ? t`before → now` : t`now`}</th>
          <th scope="col" class="number">noise</th>
        </tr>
      </thead>
      <tbody>
        ${changes.map(
          (change) => html`
            <tr key=${change.channel}>
              <th scope="row">
                ${capital(channelName(change.channel))}
                ${uses.length > 1 ? `, ${USES[change.use]}` : ""}
              </th>
              <td class="number">${changeWords(change)}</td>
              <td class="number">
                ${change.noise === null ? t`not known` : `${digits(change.noise, 2)} ${change.unit}`}
              </td>
            </tr>
          `,
        )}
      </tbody>
    </table>
  `;
}
