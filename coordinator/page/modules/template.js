// The files of a calibration of which only the runs are there: what a person says about the rig, as TOML to be edited.

import { t } from "./language/language.js";

/**
 * @typedef {{ name: string, radiusMm: number, widthMm: number, grousers: number | null, grouserHeightMm: number | null,
 *   grouserThicknessMm: number | null }} Wheel
 * @typedef {{ density: number | null, binLength: number | null, slip: Range, load: Range, speed: Range }} Bounds
 *   in SI; null: not stated
 * @typedef {[number, number] | null} Range least and greatest
 */

const key = (/** @type {string} */ name) => (/^[A-Za-z0-9_-]+$/.test(name) ? name : JSON.stringify(name));
const tidy = (/** @type {number} */ value) => String(Number(value.toPrecision(6)));

/** Lines of the keys that are stated. */
const stated = (/** @type {[string, number | Range][]} */ entries) =>
  entries
    .flatMap(([name, value]) => {
      if (value === null) return [];
      return [`${name} = ${Array.isArray(value) ? `[${value.map(tidy).join(", ")}]` : tidy(value)}`];
    })
    .join("\n");

/**
 * `experiment.toml` of wheels, a soil and the noise of the measured channels.
 * @param {{ wheels: Wheel[], soil: string, noise: Record<string, string>, bounds: Bounds }} rig noise: a number in SI
 *   or a word, by column of runs.csv
 */
export function experiment({ wheels, soil, noise, bounds }) {
  const metres = (/** @type {number | null} */ mm) => (mm === null ? null : mm / 1000);
  const tables = wheels.map(
    (wheel) =>
      `[wheel.${key(wheel.name)}]\n${stated([
        ["radius_m", wheel.radiusMm / 1000],
        ["width_m", wheel.widthMm / 1000],
        ["grouser_count", wheel.grousers],
        ["grouser_height_m", metres(wheel.grouserHeightMm)],
        ["grouser_thickness_m", metres(wheel.grouserThicknessMm)],
      ])}\n`,
  );
  const rig = stated([
    ["bin_length_m", bounds.binLength],
    ["slip_range", bounds.slip],
    ["wheel_load_range_n", bounds.load],
    ["sled_speed_range_m_s", bounds.speed],
  ]);
  const soilKeys = stated([["density_kg_m3", bounds.density]]);
  const entries = Object.entries(noise).map(
    ([channel, value]) => `${channel} = ${/^[a-z]/.test(value) ? JSON.stringify(value) : value}`,
  );
  return `runs = "runs.csv"

${tables.join("\n")}
[soil.${key(soil)}]
${soilKeys ? `${soilKeys}\n` : ""}${rig ? `\n[rig]\n${rig}\n` : ""}
[noise]                       # sd of one measurement: a number, "replicates" (from repeats) or "unknown" (inferred)
${entries.join("\n")}
`;
}

/** What is done when the calibration is over, with its meaning. @type {[string, string][]} */
export const SEARCHES = [
  ["ask", t`search for a missing effect and report it`],
  ["auto", t`search, and add what is found`],
  ["leading", t`search, and also add what leads but is not named: for predictions`],
  ["off", t`calibrate alone`],
];

/** The models, with what they are. @type {[string, string][]} */
export const MODELS = [
  ["quasi_static", t`a smooth rim in steady motion: pressure by sinkage, shear by friction; seconds`],
  ["wong_reece", t`a smooth rim whose pressure peaks ahead of the axle, shear by displacement; seconds`],
  ["rft", t`resistive force theory of dry sand, with the grousers; seconds`],
  [
    "scm",
    t`a wheel with its grousers that rolls over soil and deforms it; a thousand times slower: the most probable
      parameters alone`,
  ],
];

/** Forms of a prior, with their two numbers. @type {[string, string][]} */
export const FORMS = [
  ["uniform", t`between … and …`],
  ["normal", t`mean … and sd …`],
  ["fixed", t`fixed at …`],
];

/**
 * @typedef {{ name: string, unit: string, meaning: string, of: string[], form: string, numbers: [number, number],
 *   bounds: [number, number] | null }} Prior of: the models that have the parameter. numbers: those of the form; the
 *   second of a fixed one counts for nothing. bounds: of a normal one
 */

const SOIL = ["quasi_static", "wong_reece", "scm"];

/** The priors of dry sands, and of wheels of these radii. @returns {Prior[]} */
export function priorsOf(/** @type {{ name: string, radiusMm: number }[]} */ wheels) {
  const radii = wheels.map(({ name, radiusMm }) => ({
    name: wheels.length === 1 ? "wheel_radius_m" : `wheel_radius_m.${name}`,
    unit: "m",
    meaning: t`radius [m] of the rim with the soil that it carries along`,
    of: [...SOIL, "rft"],
    form: "uniform",
    numbers: /** @type {[number, number]} */ ([radiusMm / 1000, (1.24 * radiusMm) / 1000]),
    bounds: null,
  }));
  return [
    {
      name: "log10_p_ref",
      unit: "log10 Pa",
      meaning: t`log10 of the pressure [Pa] at 10 mm under a plate of 30 mm radius`,
      of: SOIL,
      form: "uniform",
      numbers: [3.3, 5.6],
      bounds: null,
    },
    {
      name: "kappa",
      unit: "1",
      meaning: t`k_c / (k_phi 30 mm); one wheel cannot tell k_c from k_phi`,
      of: SOIL,
      form: "fixed",
      numbers: [0, 0],
      bounds: null,
    },
    {
      name: "n",
      unit: "1",
      meaning: t`exponent of the sinkage in the pressure`,
      of: SOIL,
      form: "normal",
      numbers: [1.1, 0.2],
      bounds: [0.8, 2],
    },
    {
      name: "friction_angle_deg",
      unit: "deg",
      meaning: t`angle of internal friction [°]`,
      of: SOIL,
      form: "normal",
      numbers: [30, 5.7],
      bounds: [11.5, 45],
    },
    ...radii,
    {
      name: "xi_n_pa_m",
      unit: "Pa/m",
      meaning: t`stiffness of the sand [Pa/m]`,
      of: ["rft"],
      form: "loguniform",
      numbers: [1e5, 1e8],
      bounds: null,
    },
  ];
}

/** Numbers of TOML: whole ones have a point. */
const decimal = (/** @type {number} */ value) => (/[.e]/.test(tidy(value)) ? tidy(value) : `${tidy(value)}.0`);

function priorText(/** @type {Prior} */ { form, numbers, bounds }) {
  if (form === "fixed") return decimal(numbers[0]);
  const limits = form === "normal" && bounds ? `, bounds = [${bounds.map(decimal).join(", ")}]` : "";
  return `{ ${form} = [${numbers.map(decimal).join(", ")}]${limits} }`;
}

/**
 * `job.toml` of one model, or of several that are compared.
 * @param {{ models: string[], priors: Prior[], effects: string[], search: string }} choices effects: of the catalogue,
 *   which every model has
 */
export function job({ models, priors, effects, search }) {
  const list = effects.length > 0 ? `effects = [${effects.map((effect) => JSON.stringify(effect)).join(", ")}]\n` : "";
  const head = models.length === 1 ? "[model]" : "[[models]]";
  const tables = models.map((kind) => `${head}\nkind = ${JSON.stringify(kind)}\n${list}`);
  const lines = priors
    .filter(({ of }) => of.some((kind) => models.includes(kind)))
    .map((prior) => `${key(prior.name)} = ${priorText(prior)}      # ${prior.meaning}`);
  const algorithm = models.includes("scm")
    ? 'algorithm = "lm"            # the most probable parameters; without it, the whole posterior\n'
    : "";
  return `experiment = "experiment.toml"

${tables.join("\n")}
[priors]
${lines.join("\n")}

[sampler]
${algorithm}seed = 1

[discovery]
apply = "${search}"     # "ask": report a missing effect; "auto": also add it; "leading": or what leads; "off": none
`;
}
