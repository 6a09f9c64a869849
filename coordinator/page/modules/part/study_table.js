// The studies as a table: a row each, with the errors of its current model on fitted and held-out rows.

import { html } from "../html.js";
import { t, translated } from "../language/language.js";
import { address } from "../route.js";
import { capital, CHANNELS, errorWords, short, shown, titled, unitOf, words } from "../words/quantity.js";
import { progressWords } from "../words/state.js";
import { Tags } from "./study_details.js";
import { Table } from "./table.js";

/** An error on fitted rows, above that on held-out rows. */
const pair = (/** @type {any} */ error, /** @type {(use: any) => number | null | undefined} */ of, scale = 1) =>
  error && html`${["fit", "holdout"].filter((use) => error[use]).map((use) => {
    const value = of(error[use]);
    return html`<div>${errorWords(value === null || value === undefined ? null : value * scale)}</div>`;
  })}`;

function State(/** @type {{ study: any }} */ { study }) {
  return html`<span class=${`state ${study.state}`}>${translated(study.state)}</span>
    ${study.progress && html`<div class="note">${progressWords(study.progress)}</div>`}`;
}

/** What the study found, and what it leaves open. */
function Found(/** @type {{ study: any }} */ { study }) {
  if (study.failure) return html`<div class="note">${capital(study.failure.reason.split(" (")[0])}. <b>What to do:</b> ${study.failure.advice}.</div>`;
  const found = study.verdict?.short ?? study.models?.split(" (")[0] ?? (study.state === "finished" ? t`no search yet` : "");
  return html`${capital(found)}${study.verdict?.open && html`<div class="note">${study.verdict.open}</div>`}`;
}

/** The day of the submission, as the reader's country writes it. */
const day = (/** @type {number | null} */ ms) => (ms === null ? "" : html`<span class="whole" title=${new Date(ms).toLocaleString()}>${new Date(ms).toISOString().slice(0, 10)}</span>`);

/** @param {{ studies: any[], choose: (tag: string) => void }} properties studies: in the order in which they are shown */
export function StudyTable({ studies, choose }) {
  const channels = CHANNELS.filter((channel) => studies.some((s) => s.error?.fit?.[channel] ?? s.error?.holdout?.[channel]));
  const rows = studies.map((study) => [
    html`<a class="study-name" href=${address(["studies", study.id, ["finished", "failed"].includes(study.state) ? "story" : "live"])}>${study.name ?? t`study ${study.id}`}</a>
      <div class="note">study ${study.id}${study.archived ? t`, archived` : ""}${study.details.author && `, ${study.details.author}`}</div>
      <div><${Tags} tags=${study.details.tags} choose=${choose} /></div>`,
    day(study.created_ms),
    html`<${State} study=${study} />`,
    html`${words(study.model_kind ?? t`unknown`)}${study.effects.length > 0 && html`<div class="note">with ${study.effects.map(words).join(", ")}</div>`}`,
    study.error && html`${["fit", "holdout"].filter((use) => study.error[use]).map((use) => html`<div class="whole">${use === "fit" ? t`fit` : t`held out`}</div>`)}`,
    ...channels.map((channel) => pair(study.error, (use) => use[channel]?.rmse, shown(unitOf(channel)).scale)),
    study.error ? pair(study.error, (use) => use.all?.rmse_fixed_sigma) : html`<span class="note">${study.state === "finished" ? t`being computed` : ""}</span>`,
    html`<${Found} study=${study} />`,
  ]);
  return html`
    <p class="note">Errors are root mean squares of prediction minus measurement of the current model; 1 × noise is as good as the measurements allow.</p>
    <${Table} label="Studies" rows=${rows} numbers=${[...channels, "all"].map((_, k) => k + 5)}
      head=${[t`study`, t`begun`, t`state`, t`model`, t`rows`, ...channels.map((c) => titled(short(c), shown(unitOf(c)).unit)), t`error [× noise]`, t`found`]} />`;
}
