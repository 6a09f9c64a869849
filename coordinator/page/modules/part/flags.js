// Flags: those of the current model open, those of superseded models folded away.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { said } from "../words/clauses.js";
import { modelName } from "../words/model.js";
import { capital, words } from "../words/quantity.js";

/** @param {{ study: Study }} properties */
export function Flags({ study }) {
  const isOld = (/** @type {Flag} */ flag) =>
    flag.calibration !== null && flag.calibration !== undefined && flag.calibration !== study.current;
  const now = study.flags.filter((f) => !isOld(f));
  const old = study.flags.filter(isOld);
  const name = (/** @type {number} */ id) => {
    const member = study.members.find((m) => m.id === id);
    return member ? modelName(study, member) : t`calibration ${id}`;
  };
  const current = study.members.find((m) => m.id === study.current);
  return html`
    <h2 class="attention">What deserves attention</h2>
    ${
      now.length === 0
        ? html`<p>Nothing about the current model.</p>`
        : html`<${List} flags=${now} model=${current?.name} />`
    }
    ${
      old.length > 0 &&
      html`
        <details>
          <summary>
            ${old.length === 1 ? t`1 flag` : t`${old.length} flags`} of models that are no longer the current one
          </summary>
          ${[...new Set(old.map((f) => f.calibration))].map(
            (id) => html`
              <h3>${name(/** @type {number} */ (id))}</h3>
              <${List} flags=${old.filter((f) => f.calibration === id)} />
            `,
          )}
        </details>
      `
    }
  `;
}

/**
 * What each kind of flag is about, the weightiest first: those first that make a result wrong, last those that tell of
 * its limits.
 */
const KINDS = /** @type {Record<string, string>} */ ({
  worker: t`a worker's results differ`,
  not_equilibrated: t`sampler not settled`,
  plates_conflict: t`plates against wheel runs`,
  conflict: t`data against a prior`,
  interpolation_beats: t`interpolation predicts better`,
  chi2: t`errors larger than assumed`,
  incomplete: t`incomplete`,
  order: t`errors follow the order of the runs`,
  trend: t`errors follow a condition`,
  outlier: t`a run stands out`,
  bound: t`a parameter at its bound`,
  no_information: t`data tell little`,
  rejections: t`parameters refused`,
});

/** Number of flags that are shown at first: a screen has room for their sentences. */
const FIRST = 3;

/** Flags by the weight of their kind, those of a kind as the service orders them. */
export function byWeight(/** @type {Flag[]} */ flags) {
  const kinds = Object.keys(KINDS);
  const weight = (/** @type {Flag} */ flag) => (kinds.includes(flag.kind) ? kinds.indexOf(flag.kind) : kinds.length);
  return flags.toSorted((a, b) => weight(a) - weight(b));
}

/** @param {{ flags: Flag[], model?: string }} properties model: whose name is not said again in each line */
function List({ flags, model }) {
  const ordered = byWeight(flags);
  const later = ordered.slice(FIRST);
  const list = (/** @type {Flag[]} */ some) => html`
    <ul class="flags">
      ${some.map((f) => html`<li><b>${capital(KINDS[f.kind] ?? words(f.kind))}</b>: ${flagWords(f.text, model)}</li>`)}
    </ul>
  `;
  return html`
    ${list(ordered.slice(0, FIRST))}
    ${
      later.length > 0 &&
      html`
        <details>
          <summary>${later.length === 1 ? t`1 more flag` : t`${later.length} more flags`}</summary>
          ${list(later)}
        </details>
      `
    }
  `;
}

/** The text of a flag as people write numbers, without the name of the model that it begins with. */
export function flagWords(/** @type {string} */ text, /** @type {string | undefined} */ model) {
  return said(model !== undefined && text.startsWith(`${model}: `) ? text.slice(model.length + 2) : text);
}
