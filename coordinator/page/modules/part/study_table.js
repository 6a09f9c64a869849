// The studies as a table: a row each, with the errors of its current model on fitted and held-out rows.

import { html } from "../html.js";
import { t, translated } from "../language/language.js";
import { address } from "../route.js";
import { clauses, said, sentence } from "../words/clauses.js";
import { capital, CHANNELS, errorWords, short, shown, titled, unitOf, words } from "../words/quantity.js";
import { progressWords } from "../words/state.js";
import { Tags } from "./study_details.js";
import { Table } from "./table.js";

const USES = /** @type {const} */ (["fit", "holdout"]);

/** An error on fitted rows, above that on held-out rows; nothing for a channel without errors. */
function pair(
  /** @type {ListedStudy["error"]} */ error,
  /** @type {(table: ErrorTable) => number | null | undefined} */ valueOf,
  scale = 1,
) {
  const tables = USES.flatMap((use) => error?.[use] ?? []);
  const values = tables.map((table) => valueOf(table) ?? null);
  if (values.every((value) => value === null)) return null;
  return html`${values.map((value) => html`<div>${errorWords(value === null ? null : value * scale)}</div>`)}`;
}

function State(/** @type {{ study: ListedStudy }} */ { study }) {
  return html`
    <span class=${`state ${study.state}`}>${translated(study.state)}</span>
    ${study.progress && html`<div class="note">${progressWords(study.progress)}</div>`}
  `;
}

/** What the study found, and what it leaves open. */
function foundBy(/** @type {ListedStudy} */ study) {
  if (study.failure)
    return html`
      <div class="found">
        ${sentence(study.failure.reason.split(" (")[0])}
        <div class="note"><b>What to do:</b> ${said(study.failure.advice)}.</div>
      </div>
    `;
  const told = study.verdict?.short ?? study.models?.split(" (")[0];
  const text = told ? clauses(told).map(said).join("; ") : study.state === "finished" ? t`no search yet` : "";
  return (
    text &&
    html`
      <div class="found">
        ${capital(text)}
        ${study.verdict?.open && html`<div class="note">${said(study.verdict.open)}</div>`}
      </div>
    `
  );
}

/** The day of the submission; its title has the time in the reader's format. */
function Day(/** @type {{ ms?: number | null }} */ { ms }) {
  if (ms === null || ms === undefined) return null;
  const day = new Date(ms).toISOString().slice(0, 10);
  return html`<time class="whole" datetime=${day} title=${new Date(ms).toLocaleString()}>${day}</time>`;
}

/**
 * @param {{ studies: ListedStudy[], choose: (tag: string) => void }} properties studies: in the order in which they are
 *   shown
 */
export function StudyTable({ studies, choose }) {
  const channels = CHANNELS.filter((channel) =>
    studies.some((s) => s.error?.fit?.[channel] ?? s.error?.holdout?.[channel]),
  );
  const columns = channels.map((_, k) => k + 6);
  const rows = studies.map((study) => [
    html`
      <a
        class="study-name"
        href=${address(["studies", study.id, ["finished", "failed"].includes(study.state) ? "story" : "live"])}
      >
        ${study.name ?? t`study ${study.id}`}
      </a>
      <div class="note">
        study ${study.id}${study.archived ? t`, archived` : ""}${
          study.details.author && `, ${study.details.author}`
        }${study.created_ms !== null && ", "}<${Day} ms=${study.created_ms} />
      </div>
      ${study.details.tags.length > 0 && html`<div><${Tags} tags=${study.details.tags} choose=${choose} /></div>`}
    `,
    html`<${State} study=${study} />`,
    foundBy(study),
    html`
      <span class="whole">${words(study.model_kind ?? t`unknown`)}</span>
      ${study.effects.length > 0 && html`<div class="note">with ${study.effects.map(words).join(", ")}</div>`}
    `,
    study.error &&
      html`
        ${USES.filter((use) => study.error?.[use]).map(
          (use) => html`<div class="whole">${use === "fit" ? t`fit` : t`held out`}</div>`,
        )}
      `,
    study.error
      ? pair(study.error, (table) => table.all.rmse_fixed_sigma)
      : study.state === "finished"
        ? html`<span class="note">being computed</span>`
        : null,
    ...channels.map((channel) => pair(study.error, (table) => table[channel]?.rmse, shown(unitOf(channel)).scale)),
  ]);
  return html`
    <p class="note">
      Errors are root mean squares of prediction minus measurement of the current model; 1 × noise is as good as the
      measurements allow.
    </p>
    <${Table}
      label="Studies"
      rows=${rows}
      numbers=${[5, ...columns]}
      head=${[
        t`study`,
        t`state`,
        t`found`,
        t`model`,
        t`rows`,
        t`error [× noise]`,
        ...channels.map((c) => titled(short(c), shown(unitOf(c)).unit)),
      ]}
    />
  `;
}
