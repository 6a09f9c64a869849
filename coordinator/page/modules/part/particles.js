// The particles of a stage in two parameters, and a scrubber through the stages.

import { Figure, fileName } from "../chart/figure.js";
import { Plot, STYLE } from "../chart/library.js";
import { html, useEffect, useMemo, useState } from "../html.js";
import { t } from "../language/language.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { shownParameter } from "../words/parameter.js";
import { digits, tickWords, titled } from "../words/quantity.js";
import { Pending } from "./message.js";

const FRAME_MS = 700;

/** @typedef {{ x: number, y: number }} Point */

/** @param {{ id: number, stages: Stage[] }} properties */
export function Particles({ id, stages }) {
  const last = stages.length;
  const [asked, setStage] = useState(/** @type {number | null} */ (null));
  const [isPlaying, setPlaying] = useState(false);
  const [pair, setPair] = useState([0, 1]);
  const stage = Math.min(asked ?? last, last);
  const { answer, error } = useAnswer(path.samples(id, stage, 500));
  const first = useAnswer(path.samples(id, 1, 500));
  useEffect(() => {
    if (!isPlaying) return undefined;
    const timer = setTimeout(() => (stage >= last ? setPlaying(false) : setStage(stage + 1)), FRAME_MS);
    return () => clearTimeout(timer);
  }, [isPlaying, stage, last]);
  const play = () => {
    if (!isPlaying && stage >= last) setStage(1);
    setPlaying(!isPlaying);
  };
  const parameters = parametersOf(answer ?? first.answer);
  const chosen = pair.map((k) => Math.min(k, Math.max(0, parameters.length - 1)));
  const points = (/** @type {Population | null} */ population) =>
    (population?.samples ?? []).map((s) => ({ x: s.theta[chosen[0]], y: s.theta[chosen[1]] }));
  const now = useMemo(() => points(answer), [answer, ...chosen]);
  const early = useMemo(() => points(first.answer), [first.answer, ...chosen]);
  const exponent = stages[stage - 1]?.tempering_exponent;
  const choose = (/** @type {number} */ end) => html`
    <label>
      ${end === 0 ? t`across` : t`up`}${" "}
      <select
        value=${chosen[end]}
        onChange=${(/** @type {SelectEvent} */ { currentTarget: { value } }) =>
          setPair(pair.map((k, i) => (i === end ? Number(value) : k)))}
      >
        ${parameters.map(
          ({ name, unit }, k) =>
            html`<option value=${k} selected=${k === chosen[end]}>${shownParameter({ name, unit }).name}</option>`,
        )}
      </select>
    </label>
  `;
  return html`
    <h2>Particles</h2>
    <div class="actions">
      ${choose(0)} ${choose(1)}
      <button type="button" onClick=${play}>${isPlaying ? t`Stop` : t`Play`}</button>
      <label>
        stage <input
          type="range"
          min="1"
          max=${last}
          value=${stage}
          onInput=${(/** @type {FieldEvent} */ e) => {
            setPlaying(false);
            setStage(Number(e.currentTarget.value));
          }}
        />
      </label>
      <output>${stage} of ${last}: exponent ${digits(exponent, 2)}</output>
    </div>
    ${now.length === 0 && !isPlaying && html`<${Pending} answer=${answer} error=${error} what="This population" />`}
    ${
      now.length + early.length > 0 &&
      html`<${Cloud} id=${id} x=${parameters[chosen[0]]} y=${parameters[chosen[1]]} now=${now} early=${early} />`
    }
  `;
}

/**
 * The particles that a report carries: the first, a middle and the last stage, in two parameters.
 * @param {{ id: number }} properties
 */
export function RecordedParticles({ id }) {
  const { answer } = useAnswer(path.figures(id));
  const [place, setPlace] = useState(/** @type {number | null} */ (null));
  const populations = answer?.populations;
  if (!populations) return null;
  const { stages, parameters } = populations;
  const pointsOf = (/** @type {{ points: number[][] }} */ { points }) => points.map(([x, y]) => ({ x, y }));
  const shown = place ?? stages.length - 1;
  return html`
    <h2>Particles</h2>
    <div class="actions" role="group" aria-label="Stage">
      ${stages.map(
        (s, k) =>
          html`
            <button type="button" aria-pressed=${k === shown} onClick=${() => setPlace(k)}>
              stage ${s.stage}: exponent ${digits(s.tempering_exponent, 2)}
            </button>
          `,
      )}
    </div>
    <${Cloud}
      id=${id}
      x=${parameters[0]}
      y=${parameters[1]}
      now=${pointsOf(stages[shown])}
      early=${pointsOf(stages[0])}
    />
  `;
}

/**
 * The parameters of a population with their units.
 * @param {{ parameters: string[], units: string[] } | null} population
 */
const parametersOf = (population) =>
  (population?.parameters ?? []).map((name, k) => ({ name, unit: population?.units[k] ?? "1" }));

/**
 * @param {{ id: number, x: { name: string, unit: string }, y: { name: string, unit: string }, now: Point[], early:
 *   Point[] }} properties
 */
function Cloud({ id, x, y, now, early }) {
  const [across, up] = [x, y].map(shownParameter);
  const at = { x: (/** @type {Point} */ p) => across.of(p.x), y: (/** @type {Point} */ p) => up.of(p.y) };
  const axis = (/** @type {import("../words/parameter.js").ShownParameter} */ { name, unit, isLogarithm }) => ({
    label: titled(name, unit),
    labelArrow: /** @type {const} */ ("none"),
    ticks: 6,
    tickFormat: tickWords,
    ...(isLogarithm ? { type: /** @type {const} */ ("log") } : {}),
  });
  return html`
    <${Figure}
      title=${t`Particles in ${across.name} and ${up.name}`}
      note="grey: the first stage, close to the prior"
      name=${fileName("particles", id, x.name, y.name)}
      deps=${[now, early]}
      rows=${() => now}
      draw=${(/** @type {number} */ width) =>
        Plot.plot({
          width: Math.min(width, 640),
          height: 380,
          marginLeft: 64,
          marginTop: 26,
          marginBottom: 40,
          grid: true,
          style: STYLE,
          x: { ...axis(across), labelAnchor: "center" },
          y: axis(up),
          marks: [
            Plot.dot(early, { ...at, r: 1.6, fill: "var(--rule)" }),
            Plot.dot(now, { ...at, r: 2, fill: "var(--series-0)", fillOpacity: 0.6 }),
          ],
        })}
    />
  `;
}
