// The runs that are chosen, and what can be done with them: a bar at the bottom of every view.

import { html, useEffect, useRef, useState } from "../html.js";
import { t } from "../language/language.js";
import { errorOf, isReport } from "../rest/answers.js";
import { get, path, whatIf } from "../rest/routes.js";
import { address, parse, replace } from "../route.js";
import { choose, useChosen } from "../selection.js";
import { Failure } from "./message.js";

/** More names make an address that mail programs break. */
const MOST_NAMES = 60;

/** The names of chosen runs for the address; null where they do not fit into one. */
function named(/** @type {{ runs: Set<string> } | null} */ chosen) {
  const names = [...(chosen?.runs ?? [])];
  return names.length === 0 || names.length > MOST_NAMES || names.some((name) => name.includes(","))
    ? null
    : names.join(",");
}

/**
 * @param {{ study: Study, model: Member, asked?: string, view?: string }} properties asked: the runs of the address.
 *   view: the one that is shown
 */
export function ChosenRuns({ study, model, asked, view }) {
  const chosen = useChosen();
  const known = useRef(/** @type {string | null} */ (null));
  useEffect(() => {
    if (isReport) return;
    // An address brings its choice with it, and has the one that is made.
    const { place, query } = parse(location.hash);
    const now = named(chosen);
    const [first] = [query.runs].filter((runs) => runs && runs !== known.current);
    known.current = first ?? now;
    if (first) {
      const names = first.split(",");
      choose(names, names.length === 1 ? t`run ${names[0]}` : t`${names.length} runs`);
    } else if ((query.runs ?? null) !== now) replace(address(place, { ...query, runs: now }));
  }, [chosen, asked, view]);
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isBusy, setBusy] = useState(false);
  if (!chosen) return null;
  const runs = [...chosen.runs];
  const ask = async () => {
    setFailure(null);
    setBusy(true);
    try {
      const { rows } = await get(path.comparison(model.id));
      const fitted = new Set(rows.filter((r) => r.use === "fit").map((r) => r.run));
      const without = runs.filter((run) => fitted.has(run));
      if (without.length === 0) throw new Error(t`these runs are held out already: choose runs that are fitted`);
      const created = await whatIf(model.id, without);
      choose(null);
      location.hash = address(["beside", study.id, created.study]);
    } catch (error) {
      setFailure(errorOf(error));
    }
    setBusy(false);
  };
  return html`
    <aside class="chosen-runs" aria-label="Chosen runs">
      <p>
        <b>${chosen.label}</b>: ${runs.length === 1 ? t`1 run` : t`${runs.length} runs`}${" "}
        <span class="note">
          ${runs.length <= 8 ? runs.join(", ") : t`${runs.slice(0, 8).join(", ")} and ${runs.length - 8} more`}
        </span>
      </p>
      ${
        !isReport &&
        model &&
        html`
          <button class="main" type="button" disabled=${isBusy} onClick=${ask}>
            What if these runs were left out?
          </button>
        `
      }
      <button type="button" onClick=${() => choose(null)}>Let them go</button>
      <${Failure} error=${failure} />
    </aside>
  `;
}
