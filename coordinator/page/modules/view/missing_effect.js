// What is missing: the explanations with their probabilities, what each would change, what was not tried, and which
// runs would tell.

import { html, useMemo, useState } from "../html.js";
import { varying } from "../chart/condition.js";
import { LawChart } from "../chart/law_chart.js";
import { InformationMap } from "../chart/information_map.js";
import { t, translated } from "../language/language.js";
import { ChannelCharts } from "../part/channel_charts.js";
import { Clauses } from "../part/clauses.js";
import { Explanations, useTitles } from "../part/explanations.js";
import { Formulas } from "../part/formulas.js";
import { LibraryButton } from "../part/library_button.js";
import { Failure, Pending } from "../part/message.js";
import { NewRuns } from "../part/new_runs.js";
import { NoModel } from "../part/no_model.js";
import { NotTried } from "../part/not_tried.js";
import { errorOf, isReport } from "../rest/answers.js";
import { discover, extend, path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address, replace } from "../route.js";
import { benchTest } from "../words/bench_test.js";
import { byChange, withGhost, withoutChange } from "../words/ghost.js";
import { capital } from "../words/quantity.js";

/**
 * @param {{ study: Study, model: Member, query: Record<string, string>, reload?: () => void }} properties query.effect:
 *   whose curves are kept over the data
 */
export function MissingEffect({ study, model, query, reload }) {
  const searches = study.members.filter((m) => m.kind === "search" && m.searches === model?.id);
  const search = searches.findLast((m) => m.state === "finished") ?? searches.at(-1);
  const isFound = search?.state === "finished";
  const isLost = search?.state === "failed" || search?.state === "cancelled";
  const { answer: record, error } = useAnswer(search && isFound ? path.discovery(search.id) : null);
  const { answer: comparison } = useAnswer(model ? path.comparison(model.id) : null);
  const [pointed, setPointed] = useState(/** @type {string | null} */ (null));
  const [kept, setKept] = useState(/** @type {string | null} */ (query.effect ?? null));
  const ghost = pointed ?? kept;
  const titleOf = useTitles(model);
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isBusy, setBusy] = useState(false);
  const unchanged = useMemo(() => withoutChange(comparison?.rows ?? [], record?.curves), [comparison, record]);
  if (!model) return html`<${NoModel} study=${study} />`;
  // The address holds the choice, so that everybody who opens it sees the same curves.
  const keep = (/** @type {string | null} */ effect) => {
    setKept(effect);
    if (!isReport) replace(address(["studies", study.id, "effects"], { ...query, effect }));
  };
  const act = async (/** @type {() => Promise<Schemas["CalibrationCreated"]>} */ what) => {
    setFailure(null);
    setBusy(true);
    try {
      const created = await what();
      reload?.();
      location.hash = address(["studies", created.study, "live"]);
    } catch (problem) {
      setFailure(errorOf(problem));
    }
    setBusy(false);
  };
  if (!search || isLost) {
    return html`
      <p>
        ${
          isLost
            ? t`The search is ${translated(search.state)}${search.message ? `: ${search.message}` : ""}.`
            : t`Nobody has asked yet what this model is missing.`
        }
      </p>
      ${
        isReport
          ? html`<p>Ask, in the folder of this report, with <code>coordinator discover ${model.id} --out .</code></p>`
          : html`
              <button class="main" type="button" disabled=${isBusy} onClick=${() => act(() => discover(model.id))}>
                Search for the missing effect
              </button>
            `
      }
      <${Failure} error=${failure} />
    `;
  }
  if (!isFound)
    return html`
      <p class="empty">
        The search
        is ${translated(search.state)}${search.message ? `: ${search.message}` : ""}; <a
          href=${address(["studies", study.id, "live"])}
        >
          Live
        </a> shows
        how far it is.
      </p>
    `;
  if (!record) return html`<${Pending} answer=${record} error=${error} what="the search" />`;
  const add = (/** @type {Schemas["NewExtension"]} */ extension) => act(() => extend(model.id, extension));
  const { outside } = record;
  const layers = comparison ? withGhost(comparison.rows, record.curves, ghost) : [];
  return html`
    <div class="verdict"><${Clauses} text=${record.text} /></div>
    <${Failure} error=${failure} />
    <div class="beside">
      <div>
        <${Explanations}
          record=${record}
          unchanged=${unchanged}
          ghost=${ghost}
          kept=${kept}
          show=${setPointed}
          keep=${keep}
          add=${isReport ? null : add}
          study=${study}
          model=${model}
          isBusy=${isBusy}
          reload=${reload}
        />
      </div>
      <div class="ghosts">
        <p class="note" aria-live="polite">
          ${
            ghost
              ? html`
                  <b>${titleOf(ghost)}</b>: the dashed curves are what it would predict for the fitted runs, from the
                  search's fit. Nothing has been computed anew.
                `
              : t`Point at an explanation: its predictions appear over the data before anything is computed; a click on
                its name keeps them.`
          }
        </p>
        ${
          comparison &&
          html`
            <${ChannelCharts}
              small=${true}
              isLow=${true}
              order=${byChange(comparison.rows, record.curves, ghost)}
              layers=${layers}
              axis=${varying(comparison.rows)[0]}
              name=${`${study.name}-ghost`}
            />
          `
        }
      </div>
    </div>
    ${
      outside &&
      html`
        <${LawChart}
          law=${outside}
          name=${study.name}
          add=${isReport ? null : () => add({ effect_file: effectFile(outside.effect_file) })}
        />
        ${
          outside.formulas &&
          html`
            <${Formulas}
              formulas=${outside.formulas}
              variable=${outside.depends_on}
              add=${isReport ? null : (/** @type {string} */ text) => add({ effect_file: effectFile(text) })}
            />
          `
        }
        ${!isReport && html`<${LibraryButton} calibration=${model.id} />`}
      `
    }
    <${NotTried} record=${record} />
    <h2>Which runs would tell</h2>
    ${
      record.next_runs.length === 0 &&
      html`<p>No run within reach of the rig would change these probabilities by much.</p>`
    }
    <${InformationMap} record=${record} name=${study.name} />
    ${
      record.other_tests.length > 0 &&
      html`
        <h3>Tests without a rolling wheel that would tell</h3>
        <ul>${record.other_tests.map((text) => html`<${BenchTest} text=${text} />`)}</ul>
      `
    }
    ${
      !isReport &&
      comparison &&
      html`<${NewRuns} study=${study} model=${model} record=${record} comparison=${comparison} reload=${reload} />`
    }
  `;
}

/** A test without a rolling wheel; where its result is stated in the files is folded. */
function BenchTest(/** @type {{ text: string }} */ { text }) {
  const { what, place } = benchTest(text);
  return html`
    <li>
      ${capital(what)}${" "}
      ${
        place &&
        html`<details data-fold=${text}><summary>In detail</summary><span class="note">${place}</span></details>`
      }
    </li>
  `;
}

/** An effect file under the name of its effect, so that a second law has another. */
const effectFile = (/** @type {string} */ text) => ({
  name: `${text.match(/^name = "(\w+)"/m)?.[1] ?? "law"}.toml`,
  text,
});
