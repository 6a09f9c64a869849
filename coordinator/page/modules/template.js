// The files of a calibration of which only the runs are there: what a person says about the rig, as TOML to be edited.

import { t } from "./language/language.js";

/**
 * @typedef {{ name: string, radiusMm: number, widthMm: number, grousers: number | null, grouserHeightMm: number | null, grouserThicknessMm: number | null }} Wheel
 * @typedef {{ density: number | null, binLength: number | null, slip: Range, load: Range, speed: Range }} Bounds
 *   in SI; null: not stated
 * @typedef {[number, number] | null} Range least and greatest
 */

const key = (/** @type {string} */ name) => (/^[A-Za-z0-9_-]+$/.test(name) ? name : JSON.stringify(name));
const tidy = (/** @type {number} */ value) => String(Number(value.toPrecision(6)));

/** Lines of the keys that are stated. */
const stated = (/** @type {[string, number | Range][]} */ entries) => entries.flatMap(([name, value]) => {
  if (value === null) return [];
  return [`${name} = ${Array.isArray(value) ? `[${value.map(tidy).join(", ")}]` : tidy(value)}`];
}).join("\n");

/**
 * `experiment.toml` of wheels, a soil and the noise of the measured channels.
 * @param {{ wheels: Wheel[], soil: string, noise: Record<string, string>, bounds: Bounds }} rig noise: a number in SI or a word, by column of runs.csv
 */
export function experiment({ wheels, soil, noise, bounds }) {
  const metres = (/** @type {number | null} */ mm) => (mm === null ? null : mm / 1000);
  const tables = wheels.map((wheel) => `[wheel.${key(wheel.name)}]\n${stated([
    ["radius_m", wheel.radiusMm / 1000], ["width_m", wheel.widthMm / 1000], ["grouser_count", wheel.grousers],
    ["grouser_height_m", metres(wheel.grouserHeightMm)], ["grouser_thickness_m", metres(wheel.grouserThicknessMm)]])}\n`);
  const rig = stated([["bin_length_m", bounds.binLength], ["slip_range", bounds.slip], ["wheel_load_range_n", bounds.load], ["sled_speed_range_m_s", bounds.speed]]);
  const soilKeys = stated([["density_kg_m3", bounds.density]]);
  const entries = Object.entries(noise).map(([channel, value]) => `${channel} = ${/^[a-z]/.test(value) ? JSON.stringify(value) : value}`);
  return `runs = "runs.csv"

${tables.join("\n")}
[soil.${key(soil)}]
${soilKeys ? `${soilKeys}\n` : ""}${rig ? `\n[rig]\n${rig}\n` : ""}
[noise]                       # sd of one measurement: a number, "replicates" (from repeats) or "unknown" (inferred)
${entries.join("\n")}
`;
}

/** What is done when the calibration is over, with its meaning. @type {[string, string][]} */
export const SEARCHES = [["ask", t`search for a missing effect and report it`], ["auto", t`search, and add what is found`], ["off", t`calibrate alone`]];

/**
 * `job.toml`: the quasi-static model with priors of dry sands.
 * @param {{ wheels: Wheel[], search: string }} rig
 */
export function job({ wheels, search }) {
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
apply = "${search}"                 # "ask": search for a missing effect and report it; "auto" also adds it; "off": none
`;
}
