// The home: all studies with the error of their current models, and the workers.

import { html, useState } from "../html.js";
import { LibraryFold } from "../part/library_fold.js";
import { Empty, Failure, Pending } from "../part/message.js";
import { StudyList } from "../part/study_list.js";
import { WorkerTable } from "../part/worker_table.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";

const LOOK_MS = 2000;
/** The same while nothing is at work: somebody may submit a study elsewhere. */
const REST_MS = 10000;
const isAtWork = (/** @type {ListedStudy[]} */ studies) =>
  studies.some(({ state }) => ["queued", "running"].includes(state));

export function Home() {
  const [isArchive, setArchive] = useState(false);
  const studies = useAnswer(isArchive ? path.allStudies : path.studies, {
    everyMs: (now) => (isAtWork(now) ? LOOK_MS : REST_MS),
  });
  const workers = useAnswer(path.workers, { everyMs: () => LOOK_MS });
  return html`
    <div class="actions heading">
      <h1>Studies</h1>
      <a class="button main" href="#/new">New calibration</a>
    </div>
    ${
      studies.answer
        ? html`<${Failure} error=${studies.error} /><${Studies} studies=${studies.answer} />`
        : html`<${Pending} answer=${studies.answer} error=${studies.error} what="The list of studies" />`
    }
    <p class="note">
      <label>
        <input
          type="checkbox"
          checked=${isArchive}
          onChange=${(/** @type {FieldEvent} */ e) => setArchive(e.currentTarget.checked)}
        /> archived
        studies, too
      </label>
    </p>
    <${LibraryFold} />
    <h2>Workers</h2>
    ${
      workers.answer
        ? html`<${Workers} workers=${workers.answer} />`
        : html`<${Pending} answer=${workers.answer} error=${workers.error} what="The list of workers" />`
    }
  `;
}

function Studies(/** @type {{ studies: ListedStudy[] }} */ { studies }) {
  if (studies.length > 0) return html`<${StudyList} studies=${studies} />`;
  return html`
    <div class="card">
      <h2>There is no study yet</h2>
      <p>
        A study calibrates a wheel–soil model against the runs of a test rig, shows where the model fails and says which
        effect it misses.
      </p>
      <p>
        <a href="#/new">Drop the files of a calibration</a> (job.toml, experiment.toml, runs.csv), or a table of
        measurements alone, or <a href="#/new?example=hidden-effect">start the example</a>, which takes a few seconds.
      </p>
    </div>
  `;
}

function Workers(/** @type {{ workers: Record<string, FarmWorker> }} */ { workers }) {
  if (Object.keys(workers).length > 0) return html`<${WorkerTable} workers=${workers} />`;
  return html`
    <${Empty}>
      No worker computes for this service. Start one on any machine that reaches
      it: <code>worker --coordinator ${location.origin}</code>
    <//>
  `;
}
