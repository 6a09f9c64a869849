// What the runs alone do not tell: wheels, noise; it becomes experiment.toml and job.toml.

import { parse } from "../columns.js";
import { html, useState } from "../html.js";
import * as template from "../template.js";
import { short } from "../words/quantity.js";

/** Units of the measured columns in which people give the noise, as factors to SI. */
const CHANNELS = { drawbar_pull_n: ["N", 1], torque_n_m: ["N m", 1], sinkage_m: ["mm", 0.001], lateral_force_n: ["N", 1] };
const CHANNEL_OF = { drawbar_pull_n: "drawbar_pull", torque_n_m: "torque", sinkage_m: "sinkage", lateral_force_n: "lateral_force" };

/** @param {{ runs: string, onFiles: (files: Record<string, string>) => void }} properties runs: the text of runs.csv */
export function RigForm({ runs, onFiles }) {
  const { header, rows } = parse(runs);
  const of = (/** @type {string} */ column) => [...new Set(rows.map((row) => row[header.indexOf(column)] ?? "").filter(Boolean))];
  const names = of("wheel");
  const channels = Object.entries(CHANNELS).filter(([channel]) => header.includes(channel));
  const [sizes, setSizes] = useState(/** @type {Record<string, string>} */ ({}));
  const [noise, setNoise] = useState(/** @type {Record<string, string>} */ ({}));
  const [said, setSaid] = useState(/** @type {string[]} */ ([]));
  const wheels = names.map((name) => ({ name, radiusMm: Number(sizes[`${name} radius`]), widthMm: Number(sizes[`${name} width`]) }));
  const soils = of("soil");
  const write = (/** @type {Event} */ event) => {
    event.preventDefault();
    const wrong = [
      ...wheels.flatMap((w) => [["radius", w.radiusMm], ["width", w.widthMm]].filter(([, mm]) => !(Number(mm) > 0)).map(([what]) => `${what} of wheel ${w.name}: a number greater than 0 mm`)),
      ...channels.filter(([c]) => noise[c] && !(Number(noise[c]) > 0)).map(([c]) => `noise of ${short(CHANNEL_OF[/** @type {keyof typeof CHANNEL_OF} */ (c)])}: a number greater than 0, or nothing`),
      ...(soils.length > 1 ? [`one soil: runs.csv has ${soils.join(", ")}, and an experiment has one`] : []),
    ];
    setSaid(wrong);
    if (wrong.length > 0) return;
    const sds = Object.fromEntries(channels.map(([c, [, scale]]) => [c, noise[c] ? String(Number((Number(noise[c]) * Number(scale)).toPrecision(9))) : "unknown"]));
    onFiles({ "experiment.toml": template.experiment({ wheels, soil: soils[0] ?? "soil", noise: sds }), "job.toml": template.job({ wheels }) });
  };
  const field = (/** @type {string} */ label, /** @type {string} */ value, /** @type {(text: string) => void} */ onText) => html`
    <label class="field">${label} <input size="8" inputmode="decimal" value=${value} onInput=${(/** @type {any} */ e) => onText(e.target.value.replace(",", "."))} /></label>`;
  return html`
    <form class="card rig" onSubmit=${write}>
      <h2>Wheel and noise</h2>
      <p>The runs are there. This is what they do not tell; experiment.toml and job.toml are written from it, and you can edit them.</p>
      ${names.map((name) => html`<div class="actions">
        ${field(`radius of wheel ${name} [mm]`, sizes[`${name} radius`] ?? "", (text) => setSizes({ ...sizes, [`${name} radius`]: text }))}
        ${field(`width of wheel ${name} [mm]`, sizes[`${name} width`] ?? "", (text) => setSizes({ ...sizes, [`${name} width`]: text }))}
      </div>`)}
      <p class="note">The noise is the standard deviation of one measurement. Where the field is blank, it is inferred with the model.</p>
      <div class="actions">${channels.map(([c, [unit]]) => field(`noise of ${short(CHANNEL_OF[/** @type {keyof typeof CHANNEL_OF} */ (c)])} [${unit}]`, noise[c] ?? "", (text) => setNoise({ ...noise, [c]: text })))}</div>
      ${said.map((problem) => html`<p class="error" role="alert">${problem}</p>`)}
      <button class="main" type="submit">Write experiment.toml and job.toml</button>
    </form>`;
}
