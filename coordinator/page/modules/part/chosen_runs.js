// The runs that are chosen, and what can be done with them: a bar at the bottom of every view.

import { html, useState } from "../html.js";
import { isReport } from "../rest/answers.js";
import { path, whatIf } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address } from "../route.js";
import { choose, useChosen } from "../selection.js";
import { Failure } from "./message.js";

/** More names are counted. */
const MOST_NAMES = 8;
const count = (/** @type {number} */ n) => (n === 1 ? "1 run" : `${n} runs`);

/** @param {{ study: any, model: any }} properties */
export function ChosenRuns({ model }) {
  const chosen = useChosen();
  const { answer: comparison } = useAnswer(chosen && model ? path.comparison(model.id) : null);
  const [failure, setFailure] = useState(/** @type {any} */ (null));
  if (!chosen) return null;
  const runs = [...chosen.runs];
  const rows = comparison?.rows ?? [];
  const fitted = runs.filter((run) => rows.some((/** @type {any} */ r) => r.run === run && r.use !== "holdout"));
  const ask = async () => {
    setFailure(null);
    try {
      const created = await whatIf(model.id, fitted);
      choose(null);
      location.hash = address(["studies", created.study, "live"]);
    } catch (error) {
      setFailure(error);
    }
  };
  return html`
    <aside class="chosen-runs" aria-label="Chosen runs">
      <p><b>${chosen.label}</b>: ${count(runs.length)}, of which ${fitted.length} fitted${" "}
        <span class="note">${runs.slice(0, MOST_NAMES).join(", ")}${runs.length > MOST_NAMES ? ` and ${runs.length - MOST_NAMES} more` : ""}</span></p>
      ${!isReport && fitted.length > 0 && html`<button class="main" type="button" onClick=${ask}>What if these runs were left out?</button>`}
      <button type="button" onClick=${() => choose(null)}>Let them go</button>
      <${Failure} error=${failure} />
    </aside>`;
}
