// The files of a calibration before it is sent: what each is, which ones they name, and what is missing.

import { isRuns, parse } from "./columns.js";
import { t } from "./language/language.js";

/** @typedef {{ name: string, text: string }} NamedText */
/** @typedef {Record<string, string>} Files texts by name */

/** What a file is: told by its content, since people name files as they like. */
export function kindOf(/** @type {string} */ name, /** @type {string} */ text) {
  if (/\.toml$/i.test(name)) {
    if (/^\s*\[(wheel|soil|noise)\b/m.test(text)) return "experiment";
    if (/^\s*\[(model|priors|sampler)\]/m.test(text) || /^\s*experiment\s*=/m.test(text)) return "job";
    return "effect";
  }
  if (!/\.(csv|txt|tsv|dat)$/i.test(name)) return text.includes("\0") || text.includes("\ufffd") ? "binary" : "file";
  const { header } = parse(text);
  if (isRuns(header)) return "runs";
  if (header.includes("t_s")) return "history";
  if (header.includes("plate_radius_m") || header.includes("normal_stress_pa")) return "readings";
  if (header.includes("log_likelihood")) return "posterior";
  return "table";
}

const base = (/** @type {string} */ name) => name.split(/[\\/]/).pop() ?? name;

/** A file by its name, or by the name without folders. */
export const find = (/** @type {Files} */ files, /** @type {string} */ name) =>
  Object.keys(files).find((own) => own === name) ?? Object.keys(files).find((own) => base(own) === base(name)) ?? null;

const strip = (/** @type {string} */ text) => text.replace(/^((?:[^"#\n]|"[^"\n]*")*)#.*$/gm, "$1");

/** The strings of a key of a TOML text: one, or a list of them. */
function strings(/** @type {string} */ text, /** @type {string} */ key) {
  const found = [...strip(text).matchAll(new RegExp(`^\\s*${key}\\s*=\\s*(\\[[^\\]]*\\]|"[^"]*"|'[^']*')`, "gm"))];
  return found.flatMap(([, value]) => [...value.matchAll(/"([^"]*)"|'([^']*)'/g)].map(([, a, b]) => a ?? b));
}

/** The recordings that a runs.csv names. */
function recordings(/** @type {string} */ text) {
  const { header, rows } = parse(text);
  const column = header.indexOf("history");
  return column < 0 ? [] : rows.map((row) => row[column] ?? "").filter(Boolean);
}

/** The experiment that a job names; the only one there is where it names another. */
export function experimentOf(/** @type {Files} */ files, /** @type {string} */ job) {
  const named = strings(files[job] ?? "", "experiment")[0];
  const own = named === undefined ? null : find(files, named);
  const all = Object.keys(files).filter((name) => kindOf(name, files[name]) === "experiment");
  return own ?? (all.length === 1 ? all[0] : null);
}

/** What a job and its experiment name: the name as it is written, and by whom. */
export function named(/** @type {Files} */ files, /** @type {string} */ job, /** @type {string | null} */ experiment) {
  const of = (/** @type {string} */ by, /** @type {string[]} */ keys) =>
    keys.flatMap((key) => strings(files[by] ?? "", key)).map((name) => ({ name, by }));
  const own = experiment === null ? [] : of(experiment, ["runs", "plates", "shear", "mesh"]);
  const histories = own.flatMap(({ name }) => {
    const file = find(files, name);
    return file && kindOf(file, files[file]) === "runs"
      ? recordings(files[file]).map((recording) => ({ name: recording, by: file }))
      : [];
  });
  return { job: of(job, ["effect_files", "posterior"]), experiment: [...own, ...histories] };
}

/** What is missing before a job can start, in words. */
export function missing(/** @type {Files} */ files, /** @type {string | null} */ job) {
  if (job === null) return [t`a job file (job.toml): it names the model, the priors and the sampler`];
  const experiment = experimentOf(files, job);
  const list = named(files, job, experiment);
  const absent = [...list.experiment, ...list.job].filter(({ name }) => find(files, name) === null);
  const words = absent.map(({ name, by }) => t`${name}, which ${by} names`);
  if (experiment === null)
    words.unshift(
      t`${strings(files[job], "experiment")[0] ?? "experiment.toml"}, the experiment of ${job}: it describes wheel, soil
        and noise`,
    );
  return [...new Set(words)];
}

/** The two requests of a calibration, without the files that nobody names. */
export function requests(/** @type {Files} */ files, /** @type {string} */ job, /** @type {string} */ experiment) {
  const list = named(files, job, experiment);
  const texts = (/** @type {{ name: string }[]} */ of) =>
    Object.fromEntries(of.map(({ name }) => [name, files[find(files, name) ?? ""] ?? ""]));
  return {
    experiment: { toml: files[experiment], files: texts(list.experiment) },
    job: { toml: files[job], files: texts(list.job) },
  };
}

/** The file that a message of the service is about: the service calls the two TOML files by their usual names. */
export function fileOf(
  /** @type {string} */ message,
  /** @type {Files} */ files,
  /** @type {string | null} */ job,
  /** @type {string | null} */ experiment,
) {
  const name = /^([^\s:]+\.\w+)[ :]/.exec(message)?.[1];
  if (name === undefined) return null;
  if (name === "job.toml") return job;
  if (name === "experiment.toml") return experiment;
  return find(files, name);
}
