// What the runs alone do not tell: wheels, soil, rig, noise; it becomes experiment.toml and job.toml.

import { parse } from "../columns.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import * as template from "../template.js";
import { numberOf, short } from "../words/quantity.js";
import { badPriors, ModelChoices, priorsOf } from "./model_choices.js";

/** Units of the measured columns in which people give the noise, as factors to SI. */
const CHANNELS = {
  drawbar_pull_n: ["N", 1],
  torque_n_m: ["N m", 1],
  sinkage_m: ["mm", 0.001],
  lateral_force_n: ["N", 1],
};
const CHANNEL_OF = {
  drawbar_pull_n: "drawbar_pull",
  torque_n_m: "torque",
  sinkage_m: "sinkage",
  lateral_force_n: "lateral_force",
};
/** Sizes of a wheel with their units; those after the second may be blank. @type {[string, string, string][]} */
const SIZES = [
  ["radius", t`radius`, "mm"],
  ["width", t`width`, "mm"],
  ["grousers", t`number of grousers`, ""],
  ["height", t`height of grousers`, "mm"],
  ["thickness", t`thickness of grousers`, "mm"],
];
const NEEDED = ["radius", "width"];
/** Properties of soil and rig, which some effects need. @type {[string, string, string][]} */
const PROPERTIES = [
  ["density", t`bulk density of the soil`, "kg/m³"],
  ["bin", t`length of the bin`, "m"],
];
/** What the rig can be set to, with the factor to SI. @type {[string, string, string, number][]} */
const RANGES = [
  ["slip", t`slip`, "%", 0.01],
  ["load", t`wheel load`, "N", 1],
  ["speed", t`sled speed`, "mm/s", 0.001],
];

/** @param {{ runs: string, onFiles: (files: Record<string, string>) => void }} properties runs: the text of runs.csv */
export function RigForm({ runs, onFiles }) {
  const { header, rows } = parse(runs);
  const of = (/** @type {string} */ column) => [
    ...new Set(rows.map((row) => row[header.indexOf(column)] ?? "").filter(Boolean)),
  ];
  const names = of("wheel");
  const soils = of("soil");
  const channels = Object.entries(CHANNELS).filter(([channel]) => header.includes(channel));
  const [typed, setTyped] = useState(/** @type {Record<string, string>} */ ({}));
  const [choices, setChoices] = useState(
    /** @type {import("./model_choices.js").Choices} */ ({
      models: ["quasi_static"],
      changed: {},
      effects: [],
      search: template.SEARCHES[0][0],
    }),
  );
  const [said, setSaid] = useState(/** @type {string[]} */ ([]));
  const value = (/** @type {string} */ key) =>
    (typed[key] ?? "").trim() === "" ? null : (numberOf(typed[key]) ?? NaN);
  const isBad = (/** @type {number | null} */ number) => number !== null && !(number > 0);
  const noiseOf = (/** @type {string} */ c) => short(CHANNEL_OF[/** @type {keyof typeof CHANNEL_OF} */ (c)]);
  const range = (/** @type {string} */ key, /** @type {number} */ scale) => {
    const [low, high] = ["from", "to"].map((end) => value(`${key} ${end}`));
    return low === null && high === null
      ? null
      : /** @type {[number, number]} */ ([(low ?? NaN) * scale, (high ?? NaN) * scale]);
  };
  const write = (/** @type {Event} */ event) => {
    event.preventDefault();
    const ranges = Object.fromEntries(RANGES.map(([key, , , scale]) => [key, range(key, scale)]));
    const wrong = [
      ...names.flatMap((name) =>
        SIZES.flatMap(([key, words]) => {
          const number = value(`${name} ${key}`);
          const isWrong = NEEDED.includes(key) ? number === null || isBad(number) : isBad(number);
          return isWrong ? [t`${words} of wheel ${name}: a number greater than 0`] : [];
        }),
      ),
      ...[...channels.map(([c]) => [c, t`noise of ${noiseOf(c)}`]), ...PROPERTIES]
        .filter(([key]) => isBad(value(key)))
        .map(([, words]) => t`${words}: a number greater than 0, or nothing`),
      ...RANGES.filter(([key]) => ranges[key] && !(ranges[key][0] <= ranges[key][1])).map(
        ([, words]) => t`limits of ${words}: two numbers, the smaller first`,
      ),
      ...badPriors(choices, names),
      ...(choices.models.length === 0 ? [t`choose a model`] : []),
      ...(soils.length > 1 ? [t`one soil: runs.csv has ${soils.join(", ")}, and an experiment has one`] : []),
    ];
    setSaid(wrong);
    if (wrong.length > 0) return;
    const wheels = names.map((name) => {
      const [radiusMm, widthMm, grousers, grouserHeightMm, grouserThicknessMm] = SIZES.map(([key]) =>
        value(`${name} ${key}`),
      );
      return {
        name,
        radiusMm: radiusMm ?? NaN,
        widthMm: widthMm ?? NaN,
        grousers,
        grouserHeightMm,
        grouserThicknessMm,
      };
    });
    const sds = Object.fromEntries(
      channels.map(([c, [, scale]]) => {
        const sd = value(c);
        return [c, sd === null ? "unknown" : String(Number((sd * Number(scale)).toPrecision(9)))];
      }),
    );
    const bounds = {
      density: value("density"),
      binLength: value("bin"),
      slip: ranges.slip,
      load: ranges.load,
      speed: ranges.speed,
    };
    onFiles({
      "experiment.toml": template.experiment({ wheels, soil: soils[0] ?? "soil", noise: sds, bounds }),
      "job.toml": template.job({ ...choices, priors: priorsOf(choices, wheels) }),
    });
  };
  const field = (/** @type {string} */ key, /** @type {string} */ label) => html`
    <label class="field">
      ${label}${" "}
      <input
        size="8"
        inputmode="decimal"
        value=${typed[key] ?? ""}
        onInput=${(/** @type {FieldEvent} */ e) => setTyped({ ...typed, [key]: e.currentTarget.value })}
      />
    </label>
  `;
  const unit = (/** @type {string} */ name) => (name === "" ? "" : ` [${name}]`);
  return html`
    <form class="card rig" onSubmit=${write}>
      <h2>Wheel and noise</h2>
      <p>
        The runs are there. This is what they do not tell; experiment.toml and job.toml are written from it, and you can
        edit them.
      </p>
      ${names.map(
        (name) =>
          html`
            <div class="actions">
              ${SIZES.map(([key, words, of]) => field(`${name} ${key}`, t`${words} of wheel ${name}${unit(of)}`))}
            </div>
          `,
      )}
      <p class="note">Without grousers, leave their fields blank.</p>
      <p class="note">
        The noise is the standard deviation of one measurement. Where the field is blank, it is inferred with the model;
        a misfit then counts as noise.
      </p>
      <div class="actions">${channels.map(([c, [of]]) => field(c, t`noise of ${noiseOf(c)} [${of}]`))}</div>
      <h3>Soil and rig</h3>
      <p class="note">
        All may stay blank. Some effects need the density or the length of the bin; runs are proposed within the limits.
      </p>
      <div class="actions">${PROPERTIES.map(([key, words, of]) => field(key, `${words}${unit(of)}`))}</div>
      <div class="actions">
        ${RANGES.map(
          ([key, words, of]) =>
            html`${field(`${key} from`, t`${words} at least [${of}]`)} ${field(`${key} to`, t`at most [${of}]`)}`,
        )}
      </div>
      <${ModelChoices} choices=${choices} wheels=${names} change=${setChoices} />
      ${said.map((problem) => html`<p class="error" role="alert">${problem}</p>`)}
      <p><button class="main" type="submit">Write experiment.toml and job.toml</button></p>
    </form>
  `;
}
