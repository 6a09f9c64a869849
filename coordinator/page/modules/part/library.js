// The laws that joined the library: where each held, and what the studies say together.

import { html, useState } from "../html.js";
import { language, t, translated } from "../language/language.js";
import { path, removeFromLibrary } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { sentence } from "../words/clauses.js";
import { digits, probability } from "../words/quantity.js";
import { Failure, Pending } from "./message.js";
import { Table } from "./table.js";

/** @typedef {import("../../types/api").components["schemas"]["LibraryLaw"]} LibraryLaw */
/** @typedef {import("../../types/api").components["schemas"]["LawInStudy"]} LawInStudy */

export function Library() {
  const { answer: laws, error, reload } = useAnswer(path.library);
  if (!laws) return html`<${Pending} answer=${laws} error=${error} what="The library" />`;
  if (laws.length === 0) {
    return html`
      <p class="note">
        No law has joined the library. A law that a search finds outside the catalogue is added to it under
        <i>Missing effect</i>, an effect file by <code>coordinator library add FILE</code>; later searches try it.
      </p>
    `;
  }
  return laws.map((/** @type {LibraryLaw} */ law) => html`<${Law} key=${law.name} law=${law} onChange=${reload} />`);
}

/** @param {{ law: LibraryLaw, onChange: () => void }} properties */
function Law({ law, onChange }) {
  const [error, setError] = useState(/** @type {unknown} */ (null));
  const remove = () => removeFromLibrary(law.name).then(onChange, setError);
  const added = new Date(law.added_at_ms).toLocaleDateString(language);
  return html`
    <section class="card">
      <div class="actions heading">
        <h3>${translated(law.summary)} <small><code>${law.name}</code></small></h3>
        <button type="button" aria-label=${t`Remove ${law.name} from the library`} onClick=${remove}>
          Remove from the library
        </button>
      </div>
      <${Failure} error=${error} />
      <p>${evidence(law)}</p>
      <p class="note">${sentence(law.source)} ${t`Version ${law.version}, in the library since ${added}.`}</p>
      ${law.studies.length > 0 && html`<${Studies} studies=${law.studies} />`}
    </section>
  `;
}

/** What the studies that count say together. */
export function evidence(/** @type {LibraryLaw} */ law) {
  if (law.counted === 0) return t`No study counts as evidence yet.`;
  const held = law.studies.filter((study) => study.counts && study.standing === "held").length;
  const sum = digits(law.log_bayes_factor);
  return law.counted === 1
    ? t`Held in ${held} of 1 study that counts (${sum} nats).`
    : t`Held in ${held} of ${law.counted} studies that count (${sum} nats together).`;
}

/** @param {{ studies: LawInStudy[] }} properties */
function Studies({ studies }) {
  const standings = { held: t`held`, undecided: t`undecided`, not_seen: t`not seen` };
  const rows = studies.map((study) => [
    html`<a href=${`#/studies/${study.study}/effects`}>${study.name}</a>`,
    standings[study.standing],
    digits(study.log_bayes_factor),
    probability(study.probability),
    Object.entries(study.parameters)
      .map(([name, value]) => parameter(name, value, study.units[name]))
      .join(", "),
    study.counts ? t`yes` : t`no: its measurements count elsewhere`,
  ]);
  return html`
    <${Table}
      label="Studies that tried the law"
      numbers=${[2, 3]}
      rows=${rows}
      head=${[t`study`, t`the law`, t`nats`, t`P`, t`its parameters`, t`counts`]}
    />
  `;
}

function parameter(/** @type {string} */ name, /** @type {number} */ value, /** @type {string | undefined} */ unit) {
  const short = name.split(".")[1] ?? name;
  return `${short} ${digits(value)}${unit && unit !== "1" ? ` ${unit}` : ""}`;
}
