// A campaign while it lasts: what the further runs change, as the events of the service tell it, and the form for the
// next run.

import { errorOf } from "../rest/answers.js";
import { table } from "../chart/download.js";
import { d3 } from "../chart/library.js";
import { html, useEffect, useState } from "../html.js";
import { t } from "../language/language.js";
import { follow } from "../rest/events.js";
import { addRuns, followRuns, path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address } from "../route.js";
import { sentence } from "../words/clauses.js";
import { conditionWords } from "../words/condition.js";
import { separatedWords } from "../words/few.js";
import { meanAndSpread, parameterValues, shownParameter } from "../words/parameter.js";
import { channelOf, quantityName } from "../words/predicted_quantity.js";
import { capital, digits, probability, size, unitOf } from "../words/quantity.js";
import { Failure } from "./message.js";
import { NewRuns } from "./new_runs.js";
import { Table } from "./table.js";

/** So many contradicting runs speak against the model rather than against a rig. */
const SEVERAL = 3;
const METHODS = /** @type {Record<string, string>} */ ({
  reweighted: t`the draws weighted anew`,
  drawn: t`new draws`,
  "calibrate again": t`must be calibrated again`,
});

/** @param {{ study: Study, model: Member, reload?: () => void }} properties */
export function Campaign({ study, model, reload }) {
  const [followed, setFollowed] = useState(/** @type {Followed | null} */ (null));
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const { answer: comparison } = useAnswer(path.comparison(model.id));
  useEffect(
    () =>
      follow(path.campaign(model.id), {
        onEvent: (/** @type {string} */ _, /** @type {Followed} */ data) => setFollowed(data),
        onError: setFailure,
        isOver: () => false,
      }),
    [model.id],
  );
  // The answer comes as an event, to this page and to all others.
  const add = async (/** @type {import("../chart/figure.js").Row[]} */ rows) => {
    await followRuns(model.id, joined(followed?.rows ?? "", table(rows)));
  };
  return html`
    <h2>Follow a campaign</h2>
    <p class="note">
      Further runs change posterior, models and verdict here at once, without a new calibration: those that are typed
      below, or that coordinator watch and other programs send. Nothing is stored.
    </p>
    <${Failure} error=${failure} />
    <div aria-live="polite">${followed && html`<${News} followed=${followed} />`}</div>
    ${
      followed &&
      html`
        <${Details} followed=${followed} />
        <${ForGood} study=${study} model=${model} rows=${followed.rows} reload=${reload} />
      `
    }
    ${
      comparison &&
      html`
        <${NewRuns}
          key=${followed?.runs.length ?? 0}
          study=${study}
          model=${model}
          record=${{ next_runs: followed?.next_runs.slice(0, 1) ?? [] }}
          comparison=${comparison}
          follow=${add}
          further=${followed?.runs.length ?? 0}
        />
      `
    }
  `;
}

/** What matters at the rig: contradictions, verdict, the next run, the end. */
function News(/** @type {{ followed: Followed }} */ { followed }) {
  const {
    runs,
    expectations,
    verdict,
    next_runs: [next],
    stop,
  } = followed;
  const far = expectations.filter((expected) => expected.contradicts);
  const wrong = new Set(far.map((expected) => expected.run)).size;
  return html`
    <p>
      ${
        runs.length === 1
          ? t`1 further run: ${runs[0]}`
          : t`${runs.length} further runs, the last ${runs[runs.length - 1]}`
      }
    </p>
    ${
      far.length > 0 &&
      html`
        <div class="error" role="alert">
          ${far.map(
            (expected) =>
              html`
                <p>
                  <b>${t`Run ${expected.run} contradicts the others`}</b>:${" "}
                  ${t`${quantityName(expected.channel)} ${valueOf(expected, "measured")}, expected near
                    ${valueOf(expected, "expected")} (P ${probability(expected.probability)})`}
                </p>
              `,
          )}
          <p>
            ${
              wrong >= SEVERAL
                ? t`So many runs contradict the model: it misses something that they show.`
                : t`Look at sensor, preparation, and the wheel on its shaft; where the run is right, the model is wrong
                  there.`
            }
          </p>
        </div>
      `
    }
    <p class="verdict">${sentence(verdict)}</p>
    ${
      next &&
      html`
        <p class="next-run">
          <b>${t`Make next: ${conditionWords(next)}.`}</b> ${t`It separates ${separatedWords(next.separates)}`}
          ${
            next.settles === null || next.settles === undefined
              ? "."
              : t`; it settles the matter with P ${probability(next.settles)}.`
          }
        </p>
      `
    }
    ${stop && html`<p class="stop"><b>More runs are not worth it:</b> ${sentence(stop)}</p>`}
  `;
}

const valueOf = (
  /** @type {Followed["expectations"][number]} */ expected,
  /** @type {"measured" | "expected"} */ key,
) => size(expected[key], unitOf(channelOf(expected.channel) ?? ""));

/** The models with their weights, the parameters, and every measurement beside what was expected. */
function Details(/** @type {{ followed: Followed }} */ { followed }) {
  const models = followed.models.map((model) => [
    model.name,
    model.weight_before.toFixed(3),
    model.weight === null || model.weight === undefined ? "–" : model.weight.toFixed(3),
    model.log_evidence === null || model.log_evidence === undefined ? "–" : digits(model.log_evidence, 4),
    METHODS[model.method] ?? model.method,
    model.ess === null || model.ess === undefined ? "–" : digits(model.ess, 3),
  ]);
  const parameters = followed.parameters.map((parameter) => {
    const called = shownParameter(parameter);
    const [low, high] = parameterValues(called, parameter.interval, parameter.mean, parameter.sd);
    return [called.name, called.unit, meanAndSpread(called, parameter.mean, parameter.sd), t`${low} to ${high}`];
  });
  const expected = followed.expectations.map((measurement) => [
    measurement.run,
    capital(quantityName(measurement.channel)),
    valueOf(measurement, "measured"),
    valueOf(measurement, "expected"),
    probability(measurement.probability),
  ]);
  return html`
    <h3>Models with all runs</h3>
    <${Table}
      label="Models with all runs"
      head=${[t`model`, t`weight before`, t`weight`, t`log-evidence`, t`by`, t`effective draws`]}
      rows=${models}
      numbers=${[1, 2, 3, 5]}
    />
    ${
      parameters.length > 0 &&
      html`
        <h3>Parameters with all runs</h3>
        <${Table}
          label="Parameters with all runs"
          head=${[t`parameter`, t`unit`, t`mean ± sd`, t`90 % interval`]}
          rows=${parameters}
          numbers=${[2, 3]}
        />
      `
    }
    <details>
      <summary>Measurements beside what was expected</summary>
      <${Table}
        label="Measurements beside what was expected"
        head=${[t`run`, t`channel`, t`measured`, t`expected`, t`P of one so far out`]}
        rows=${expected}
        numbers=${[2, 3, 4]}
      />
    </details>
  `;
}

/**
 * Calibrates the study with the further runs.
 * @param {{ study: Study, model: Member, rows: string, reload?: () => void }} properties
 */
function ForGood({ study, model, rows, reload }) {
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isBusy, setBusy] = useState(false);
  const send = async () => {
    setFailure(null);
    setBusy(true);
    try {
      const added = await addRuns(study.id, rows, model.id);
      reload?.();
      location.hash = address(["studies", added.study, "live"]);
    } catch (error) {
      setFailure(errorOf(error));
    }
    setBusy(false);
  };
  return html`
    <p class="actions">
      <button type="button" disabled=${isBusy} onClick=${send}>Calibrate with these runs for good</button>
    </p>
    <${Failure} error=${failure} />
  `;
}

/** Rows of two tables under the columns of both. */
export function joined(/** @type {string} */ before, /** @type {string} */ after) {
  const tables = [before, after]
    .filter((text) => text.trim() !== "")
    .map((text) =>
      d3
        .csvParseRows(text)
        .map((row) => row.map((cell) => cell.trim()))
        .filter((row) => !row[0].startsWith("#") && row.some((cell) => cell !== "")),
    );
  const columns = [...new Set(tables.flatMap(([header]) => header))];
  const rows = tables.flatMap(([header, ...body]) =>
    body.map((row) => columns.map((column) => row[header.indexOf(column)] ?? "")),
  );
  return `${d3.csvFormatRows([columns, ...rows])}\n`;
}
