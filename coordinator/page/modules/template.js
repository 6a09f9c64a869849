// The files of a calibration of which only the runs are there: what a person says about the rig, as TOML to be edited.

/** @typedef {{ name: string, radiusMm: number, widthMm: number }} Wheel */

const key = (/** @type {string} */ name) => (/^[A-Za-z0-9_-]+$/.test(name) ? name : JSON.stringify(name));
const tidy = (/** @type {number} */ value) => String(Number(value.toPrecision(6)));

/**
 * `experiment.toml` of wheels, a soil and the noise of the measured channels.
 * @param {{ wheels: Wheel[], soil: string, noise: Record<string, string> }} rig noise: a number in SI or a word, by column of runs.csv
 */
export function experiment({ wheels, soil, noise }) {
  const tables = wheels.map(({ name, radiusMm, widthMm }) =>
    `[wheel.${key(name)}]\nradius_m = ${tidy(radiusMm / 1000)}\nwidth_m = ${tidy(widthMm / 1000)}\n`);
  const entries = Object.entries(noise).map(([channel, value]) => `${channel} = ${/^[a-z]/.test(value) ? JSON.stringify(value) : value}`);
  return `runs = "runs.csv"

${tables.join("\n")}
[soil.${key(soil)}]

[noise]                       # sd of one measurement: a number, "replicates" (from repeats) or "unknown" (inferred)
${entries.join("\n")}
`;
}

/**
 * `job.toml`: the quasi-static model with priors of dry sands.
 * @param {{ wheels: Wheel[] }} rig
 */
export function job({ wheels }) {
  const radii = wheels.map(({ name, radiusMm }) => {
    const parameter = wheels.length === 1 ? "wheel_radius_m" : `"wheel_radius_m.${name}"`;
    return `${parameter} = { uniform = [${tidy(radiusMm / 1000)}, ${tidy((1.24 * radiusMm) / 1000)}] }      # the rim, and some soil that it carries along`;
  });
  return `experiment = "experiment.toml"

[model]
kind = "quasi_static"         # a smooth rim; "scm": a rolling wheel with grousers, a thousand times slower

[priors]
log10_p_ref = { uniform = [3.3, 5.6] }      # log10 of the pressure [Pa] at 10 mm under a plate of 30 mm radius
kappa = 0.0                                 # k_c / (k_phi 30 mm); one wheel cannot tell k_c from k_phi
n = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }
friction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 45.0] }
${radii.join("\n")}

[sampler]
seed = 1

[discovery]
apply = "ask"                 # search for a missing effect and report it; "auto" also adds it
`;
}
