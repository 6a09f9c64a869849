// The particles of a stage in two parameters, and a scrubber through the stages.

import { Figure, fileName } from "../chart/figure.js";
import { Plot, STYLE } from "../chart/library.js";
import { html, useEffect, useState } from "../html.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { digits, parameterName, parameterTitle } from "../words/quantity.js";
import { Pending } from "./message.js";

const FRAME_MS = 700;

/** @param {{ id: number, stages: any[] }} properties */
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
  const names = answer?.parameters ?? first.answer?.parameters ?? [];
  const chosen = pair.map((k) => Math.min(k, Math.max(0, names.length - 1)));
  const points = (/** @type {any} */ of) => (of?.samples ?? []).map((/** @type {any} */ s) => ({ x: s.theta[chosen[0]], y: s.theta[chosen[1]] }));
  const [now, early] = [points(answer), points(first.answer)];
  const exponent = stages[stage - 1]?.tempering_exponent;
  const choose = (/** @type {number} */ end) => html`<label>${end === 0 ? "across" : "up"} <select value=${chosen[end]}
    onChange=${(/** @type {any} */ e) => setPair(pair.map((k, i) => (i === end ? Number(e.target.value) : k)))}>
    ${names.map((/** @type {string} */ name, /** @type {number} */ k) => html`<option value=${k} selected=${k === chosen[end]}>${parameterName(name)}</option>`)}</select></label>`;
  return html`
    <h2>Particles</h2>
    <div class="actions">${choose(0)} ${choose(1)}
      <button type="button" onClick=${play}>${isPlaying ? "Stop" : "Play"}</button>
      <label>stage <input type="range" min="1" max=${last} value=${stage} onInput=${(/** @type {any} */ e) => { setPlaying(false); setStage(Number(e.target.value)); }} /></label>
      <output>${stage} of ${last}: exponent ${digits(exponent, 2)}</output></div>
    ${now.length === 0 && !isPlaying && html`<${Pending} answer=${answer} error=${error} what="This population" />`}
    ${now.length + early.length > 0 && html`<${Figure} title=${`Particles in ${parameterName(names[chosen[0]])} and ${parameterName(names[chosen[1]])}`} note="grey: stage 1, close to the prior"
      name=${fileName("particles", id, names[chosen[0]], names[chosen[1]])} deps=${[answer, first.answer, ...chosen]} rows=${() => now}
      draw=${(/** @type {number} */ width) => Plot.plot({
        width: Math.min(width, 640), height: 380, marginTop: 26, marginLeft: 64, marginBottom: 40, grid: true, style: STYLE,
        x: { label: parameterTitle(names[chosen[0]]), labelArrow: "none", labelAnchor: "center" }, y: { label: parameterTitle(names[chosen[1]]), labelArrow: "none" },
        marks: [Plot.dot(early, { x: "x", y: "y", r: 1.6, fill: "var(--rule)" }), Plot.dot(now, { x: "x", y: "y", r: 2, fill: "var(--series-0)", fillOpacity: 0.6 })],
      })} />`}`;
}
