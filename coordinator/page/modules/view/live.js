// How the sampler of a study comes to its result: state, stages, particles; it goes on after a restart of the
// coordinator.

import { html, useEffect, useRef, useState } from "../html.js";
import { t, translated } from "../language/language.js";
import { Controls } from "../part/controls.js";
import { Later } from "../part/later.js";
import { Leaders } from "../part/leaders.js";
import { Failure } from "../part/message.js";
import { Particles, RecordedParticles } from "../part/particles.js";
import { StageCharts } from "../part/stage_charts.js";
import { Table } from "../part/table.js";
import { isAddition, TakeBack } from "../part/take_back.js";
import { WorkerTable } from "../part/worker_table.js";
import { isReport } from "../rest/answers.js";
import { follow } from "../rest/events.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address, replace } from "../route.js";
import { followable } from "../words/model.js";
import { words } from "../words/quantity.js";
import { toGo } from "../words/time_to_go.js";
import { progressWords } from "../words/state.js";

const campaign = () => import("../part/campaign.js").then((module) => module.Campaign);

/** How often the workers are asked for [ms]. */
const FARM_MS = 2000;
/** The largest share that the service states before the end. */
const MOST_SHARE = 0.99;
const FINAL = ["finished", "failed", "cancelled"];
const KINDS = { sample: t`calibration`, fit: t`fit`, search: t`search for a missing effect` };

/** The member that is shown: the one that the address names, or the one that works, or the last calibration. */
function memberOf(/** @type {Study} */ study, /** @type {string | undefined} */ asked) {
  const lastWhere = (/** @type {(member: Member) => boolean} */ test) => study.members.findLast(test);
  return (
    lastWhere((m) => String(m.id) === asked) ??
    lastWhere((m) => m.state === "running") ??
    lastWhere((m) => ["paused", "queued"].includes(m.state)) ??
    lastWhere((m) => m.kind !== "search") ??
    study.members.at(-1)
  );
}

/** @param {{ study: Study, model: Member, query: Record<string, string>, reload: () => void }} properties */
export function Live({ study, model, query, reload }) {
  const member = memberOf(study, query.member ?? (isReport ? String(model?.id) : undefined));
  if (!member) return html`<p class="empty">This study has no calibration.</p>`;
  const campaignModel = followable(member, model);
  const go = (/** @type {number} */ id) => replace(address(["studies", study.id, "live"], { member: id }));
  const names = study.members.map((m) => [
    isReport
      ? m.name
      : html`<button type="button" aria-pressed=${m.id === member.id} onClick=${() => go(m.id)}>${m.name}</button>`,
    KINDS[m.kind] ?? words(m.kind),
    html`<span class=${`state ${m.state}`}>${translated(m.state)}</span>`,
    m.message ?? "",
  ]);
  return html`
    ${
      !isReport &&
      FINAL.includes(study.state) &&
      html`
        <p class="actions">
          <span>Everything in this study is over.</span>${" "}
          <a class="button main" href=${address(["studies", study.id, "story"])}>Read the story</a>
        </p>
      `
    }
    <${Member} key=${member.id} member=${member} reload=${reload} />
    ${
      !isReport &&
      isAddition(study, member) &&
      member.kind !== "search" &&
      html`
        <p><${TakeBack} study=${study} id=${member.id} label=${t`Take back this calibration`} reload=${reload} /></p>
      `
    }
    ${!isReport && !FINAL.includes(study.state) && html`<${Farm} />`}
    ${
      !isReport &&
      FINAL.includes(study.state) &&
      campaignModel &&
      html`
        <${Later}
          key=${`campaign ${campaignModel.id}`}
          title=${t`The campaign`}
          load=${campaign}
          study=${study}
          model=${campaignModel}
          reload=${reload}
        />
      `
    }
    <h2>Everything in this study</h2>
    <${Table}
      label="Calibrations and searches of the study"
      head=${[t`name`, t`what`, t`state`, t`message`]}
      rows=${names}
    />
  `;
}

/** The workers of the farm, while they are at work on this study. */
function Farm() {
  const { answer: workers } = useAnswer(path.workers, { everyMs: () => FARM_MS });
  return (
    workers &&
    html`
      <h2>Workers</h2>
      ${
        Object.keys(workers).length > 0
          ? html`<${WorkerTable} workers=${workers} />`
          : html`<p class="empty">No worker computes for this service: start one.</p>`
      }
    `
  );
}

function Member(/** @type {{ member: Member, reload: () => void }} */ { member, reload }) {
  const isOver = FINAL.includes(member.state);
  const recorded = useAnswer(isOver ? path.stages(member.id) : null);
  const [status, setStatus] = useState(/** @type {CalibrationStatus | null} */ (null));
  const [live, setLive] = useState(/** @type {Stage[]} */ ([]));
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  useEffect(() => {
    if (isReport || isOver) return undefined;
    /** @type {Parameters<typeof follow<CalibrationEvent>>[1]} */
    const listeners = {
      onEvent(event, data) {
        if (event === "status") setStatus(data);
        // A stream that is opened again begins with the first stage.
        else
          setLive((before) =>
            [...before.filter((s) => s.stage !== data.stage), data].sort((a, b) => a.stage - b.stage),
          );
      },
      onError: setFailure,
      isOver: (event, data) => event === "status" && FINAL.includes(data.state),
    };
    return follow(path.events(member.id), listeners);
  }, [member.id, isOver]);
  const stages = recorded.answer ?? live;
  const isLoading = isOver && recorded.answer === null;
  const state = isOver ? member.state : (status?.state ?? member.state);
  const progress = isOver ? null : status?.progress;
  const share = progress?.share ?? null;
  const seen = useRef(/** @type {{ share: number, ms: number } | null} */ (null));
  if (share !== null) seen.current ??= { share, ms: Date.now() };
  return html`
    <h2>${member.name}</h2>
    <p aria-live="polite">
      <span class=${`state ${state}`}>${translated(state)}</span>
      ${progress ? `: ${progressWords(progress)}` : ""}
      ${
        progress &&
        html`
          ${" "}
          <span class="note">
            ${Math.round(progress.evaluations_per_s)} evaluations/s; ${progress.rejected} rejected by the model
          </span>
        `
      }
    </p>
    ${
      share !== null &&
      html`
        <p class="whole-share">
          <label>
            Whole <progress max="1" value=${share}></progress>${" "}
            ${share < MOST_SHARE ? t`about ${Math.round(100 * share)} %` : t`the end cannot be estimated yet`}
          </label>
          ${
            share < MOST_SHARE &&
            typeof progress?.remaining_s !== "number" &&
            member.kind !== "search" &&
            seen.current &&
            html`
              ${" "}
              <span class="note">${toGo(share, seen.current, Date.now())}</span>
            `
          }
        </p>
      `
    }
    ${
      progress &&
      html`
        <p>
          <label>
            Present step <progress max=${Math.max(1, progress.step_size)} value=${progress.step_done}></progress>${" "}
            ${percentage(progress.step_done, progress.step_size)}${" "}
            <span class="note">(${progress.step_done} of ${progress.step_size} evaluations)</span>
          </label>
        </p>
      `
    }
    <${Failure} error=${failure} />
    ${
      !isReport &&
      !isOver &&
      !FINAL.includes(state) &&
      html`<${Controls} id=${member.id} state=${state} reload=${reload} />`
    }
    ${
      member.kind === "search"
        ? html`
            ${progress?.search && html`<${Leaders} search=${progress.search} />`}
            <p class="note">A search fits each candidate effect; its result is in the view Missing effect.</p>
          `
        : stages.length > 0
          ? html`
              <${StageCharts} stages=${stages} name=${member.name} />
              <${isReport ? RecordedParticles : Particles} id=${member.id} stages=${stages} />
            `
          : html`<p class="empty" aria-busy=${isLoading}>${noStages(member, isOver, isLoading)}</p>`
    }
  `;
}

/** `45 %` of a step. */
const percentage = (/** @type {number} */ done, /** @type {number} */ size) =>
  `${size > 0 ? Math.round((100 * done) / size) : 0} %`;

/** Why a calibration shows no stages. */
function noStages(/** @type {Member} */ member, /** @type {boolean} */ isOver, /** @type {boolean} */ isLoading) {
  if (isLoading) return t`Loading the stages …`;
  if (member.kind === "fit")
    return isOver
      ? t`A fit goes from step to step and has no stages; its result is in the other views.`
      : t`A fit goes from step to step; its result comes with its end.`;
  return isOver
    ? t`The calibration ended before its first stage.`
    : t`The first stage draws from the prior; pictures come with its end.`;
}
