// How far to trust a calibration: what it reached, what the data determine, where the model refuses, what it was
// computed from.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { Pending } from "../part/message.js";
import { NoModel } from "../part/no_model.js";
import { Table } from "../part/table.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { said, sentence } from "../words/clauses.js";
import { parameterTitle, shownParameter } from "../words/parameter.js";
import { capital, channelName, digits, probability, shown, titled } from "../words/quantity.js";
import { judgements } from "../words/trust.js";

/** @param {{ study: Study, model: Member }} properties */
export function Trust({ study, model }) {
  const { answer: provenance, error } = useAnswer(model ? path.provenance(model.id) : null);
  const { answer: diagnostics } = useAnswer(model ? path.diagnostics(model.id) : null);
  if (!model) return html`<${NoModel} study=${study} />`;
  if (!provenance) return html`<${Pending} answer=${provenance} error=${error} what="the account" />`;
  const line = study.ledger.find((l) => l.calibration === model.id);
  return html`
    ${
      diagnostics &&
      html`<${Verdict} judgements=${judgements(line, diagnostics, model.story?.wrong ?? { channels: [] })} />`
    }
    <details>
      <summary>Errors, interpolation and intervals, in sentences</summary>
      ${provenance.sentences.map((s) => html`<p>${sentence(s)}</p>`)}
    </details>
    ${
      provenance.notes.length > 0 &&
      html`
        <details>
          <summary>What was assumed, and what is doubtful</summary>
          <ul class="note">${provenance.notes.map((n) => html`<li>${sentence(n)}</li>`)}</ul>
        </details>
      `
    }
    ${diagnostics && html`<${Data} diagnostics=${diagnostics} /><${Refused} rejections=${diagnostics.rejections} />`}
    ${
      study.rig.length > 0 &&
      html`
        <h2>What the rig did</h2>
        ${study.rig.map((s) => html`<p>${sentence(s)}</p>`)}
        <p class="note">From repeats of a condition alone, without a model of the contact.</p>
      `
    }
    <h2>What it was computed from</h2>
    <dl>
      <dt>Model</dt>
      <dd>${provenance.model}, version ${provenance.model_version ?? "unknown"}</dd>
      <dt>Data</dt>
      <dd>${said(provenance.data)}</dd>
      ${provenance.errors.map((e) => html`<dt>Errors</dt><dd>${said(e)}</dd>`)}
      <dt>Algorithm</dt>
      <dd>${said(provenance.algorithm)}, seed ${provenance.seed}</dd>
      <dt>Program</dt>
      <dd>${provenance.program}</dd>
    </dl>
    <p class="note">
      The result is a function of job, seed and model version alone: the same three give the same numbers, bit for bit.
    </p>
    <details><summary>Text of the job</summary><pre tabindex="0">${provenance.job}</pre></details>
    ${provenance.effects.map(
      (e) => html`<details><summary>Effect ${e.name}</summary><pre tabindex="0">${e.text}</pre></details>`,
    )}
  `;
}

const LEVELS = { good: t`✓ yes`, fair: t`~ in part`, poor: t`✗ no` };

/** One line for each question, before the details. */
function Verdict(/** @type {{ judgements: import("../words/trust.js").Judgement[] }} */ { judgements: all }) {
  return html`
    <ul class="judgements" aria-label="How far to trust it, in short">
      ${all.map(
        ({ question, level, text }) =>
          html`
            <li class=${level}>
              <b>${LEVELS[level]}</b> <span>${question} <span class="note">${capital(text)}.</span></span>
            </li>
          `,
      )}
    </ul>
  `;
}

/** What each channel tells, and what the parameters know of it. */
function Data(/** @type {{ diagnostics: Diagnostics }} */ { diagnostics }) {
  const p = (/** @type {number | null | undefined} */ value) =>
    value === null || value === undefined ? "–" : value < 1e-6 ? "< 10⁻⁶" : digits(value, 2);
  const channels = diagnostics.channels.map((c) => {
    const quantity = shown(c.unit);
    const value = (/** @type {number | null | undefined} */ v) =>
      digits(typeof v === "number" ? v * quantity.scale : null);
    return [
      titled(channelName(c.channel), quantity.unit),
      c.data,
      value(c.error_sd),
      value(c.prior_predictive_sd),
      digits(c.information, 2),
      digits(c.chi_square?.chi_square),
      digits(c.chi_square?.degrees_of_freedom),
      p(c.chi_square?.p),
    ];
  });
  const parameters = diagnostics.parameters.map((q) => [
    shownParameter(q).name,
    digits(q.contraction, 2),
    p(q.conflict_p),
    q.at_bound ? t`at its bound` : "",
  ]);
  return html`
    <h2>What the data tell</h2>
    <${Table}
      label="Channels"
      head=${[t`channel`, t`rows`, t`error sd`, t`prior spread`, t`information`, t`chi-square`, t`expected`, "p"]}
      rows=${channels}
      numbers=${[1, 2, 3, 4, 5, 6, 7]}
    />
    <p class="note">
      Error sd: noise, discrepancy and shared errors together. Information: the prior's spread of a prediction over it;
      below 1 a row tells less than the prior.
    </p>
    <${Table}
      label="Parameters against their priors"
      head=${[t`parameter`, t`contraction`, t`p of prior conflict`, ""]}
      rows=${parameters}
      numbers=${[1, 2]}
    />
    <p class="note">
      Contraction: 1 less the sd after the fit over that before; 0: the data tell nothing. Prior conflict: probability
      of a posterior so far out if the prior is right.
    </p>
    ${diagnostics.verification.results > 0 && html`<p>${verified(diagnostics.verification)}</p>`}
  `;
}

/** What was computed twice. */
function verified(/** @type {Diagnostics["verification"]} */ { results, confirmed, workers }) {
  return workers < 2
    ? t`One worker computed all ${results} results, so that none was compared with another's.`
    : t`${workers} workers computed ${results} results; ${confirmed} were computed twice and agreed.`;
}

/** Where the model refuses parameters. */
function Refused(/** @type {{ rejections: Schemas["RejectionDiagnostics"] }} */ { rejections }) {
  if (rejections.prior_draws === 0) return null;
  if (rejections.prior_refused === 0)
    return html`<p>The model accepted every draw from the prior (${rejections.prior_draws}).</p>`;
  // The outer bins end at the bounds of the prior, which may be as far out as the model allows.
  const range = (
    /** @type {string} */ from,
    /** @type {string} */ to,
    /** @type {number} */ k,
    /** @type {number} */ count,
  ) => (k === 0 ? t`below ${to}` : k === count - 1 ? t`above ${from}` : `${from}${t` to `}${to}`);
  const cell = (
    /** @type {Schemas["PriorBin"]} */ bin,
    /** @type {number} */ k,
    /** @type {number} */ count,
    /** @type {(value: number) => number} */ shownValue,
  ) => {
    const end = (/** @type {number | null | undefined} */ v) => (typeof v === "number" ? digits(shownValue(v), 3) : "");
    const refused = Object.values(bin.refused).reduce((a, b) => a + b, 0);
    return html`
      <b>${refused}</b> of ${bin.draws}
      <br />
      <span class="note">${range(end(bin.from), end(bin.to), k, count)}</span>
    `;
  };
  return html`
    <h2>Where the model refuses parameters</h2>
    <p>
      It refused ${rejections.prior_refused} of ${rejections.prior_draws} draws from the
      prior${rejections.region ? t`, most of them in one region (${probability(rejections.region.p)} by chance)` : ""}.
    </p>
    <${Table}
      label="Rejections by region of the prior"
      head=${[t`parameter`, t`lowest fifth`, t`second`, t`middle`, t`fourth`, t`highest fifth`]}
      rows=${rejections.parameters.map((q) => [
        parameterTitle(q),
        ...q.bins.map((bin, k) => cell(bin, k, q.bins.length, shownParameter(q).of)),
      ])}
    />
  `;
}
