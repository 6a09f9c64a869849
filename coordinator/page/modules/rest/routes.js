// Every route that the page asks, with the type of its answer.

import { get, post, remove, request } from "./answers.js";

const study = (/** @type {number} */ id) => `/v1/studies/${id}`;
const calibration = (/** @type {number} */ id) => `/v1/calibrations/${id}`;

export const path = /** @type {Paths} */ ({
  studies: "/v1/studies",
  allStudies: "/v1/studies?archived=true",
  workers: "/v1/workers",
  examples: "/v1/examples",
  effects: "/v1/effects",
  library: "/v1/library",
  experiment: (/** @type {number} */ id) => `/v1/experiments/${id}`,
  study,
  calibration,
  comparison: (/** @type {number} */ id) => `${calibration(id)}/comparison`,
  diagnostics: (/** @type {number} */ id) => `${calibration(id)}/diagnostics`,
  figures: (/** @type {number} */ id) => `${calibration(id)}/figures`,
  provenance: (/** @type {number} */ id) => `${calibration(id)}/provenance`,
  responseSurface: (/** @type {number} */ id) => `${calibration(id)}/response-surface`,
  predictionGrid: (/** @type {number} */ id) => `${calibration(id)}/prediction-grid`,
  decision: (/** @type {number} */ id) => `${calibration(id)}/decision`,
  campaign: (/** @type {number} */ id) => `${calibration(id)}/follow`,
  job: (/** @type {number} */ id) => `${calibration(id)}/job`,
  histories: (/** @type {number} */ id) => `${calibration(id)}/histories`,
  discovery: (/** @type {number} */ id) => `${calibration(id)}/discovery`,
  stages: (/** @type {number} */ id) => `${calibration(id)}/stages`,
  events: (/** @type {number} */ id) => `${calibration(id)}/events`,
  posterior: (/** @type {number} */ id) => `${calibration(id)}/posterior`,
  samples: (/** @type {number} */ id, /** @type {number} */ stage, max = 1000) =>
    `${calibration(id)}/samples?stage=${stage}&most=${max}`,
});

export { get };

/** @returns {Promise<Schemas["NewState"]>} */
export const control = (/** @type {number} */ id, /** @type {"pause" | "resume" | "cancel"} */ verb) =>
  post(`${calibration(id)}/${verb}`);

/** @returns {Promise<Schemas["CalibrationCreated"]>} */
export const extend = (/** @type {number} */ id, /** @type {Schemas["NewExtension"]} */ extension) =>
  post(`${calibration(id)}/extend`, extension);

/** @returns {Promise<Schemas["Withdrawn"]>} */
export const withdraw = (/** @type {number} */ id) => post(`${calibration(id)}/withdraw`);

/** @returns {Promise<Schemas["StudyDetails"]>} */
export const describe = (/** @type {number} */ id, /** @type {Schemas["StudyDetails"]} */ details) =>
  post(`${study(id)}/details`, details);

/** The report of a study as a file. @returns {Promise<Blob>} */
export const reportOf = async (/** @type {number} */ id) => (await request("GET", `${calibration(id)}/report`)).blob();

/** @returns {Promise<Schemas["Prediction"]>} */
export const predict = (/** @type {number} */ id, /** @type {Partial<Schemas["NewPrediction"]>} */ asked) =>
  post(`${calibration(id)}/predict`, asked);

/** @returns {Promise<Schemas["DecisionAnswer"]>} */
export const decide = (/** @type {number} */ id, /** @type {string} */ file) =>
  post(`${calibration(id)}/decide`, { file });

/** @returns {Promise<Schemas["Followed"]>} */
export const followRuns = (/** @type {number} */ id, /** @type {string} */ runs) => post(path.campaign(id), { runs });

/** @returns {Promise<Schemas["JobCheck"]>} */
export const check = (/** @type {Schemas["NewCheck"]} */ job) => post("/v1/check", job);

/** @returns {Promise<Schemas["LibraryLaw"]>} */
export const addToLibrary = (/** @type {Schemas["NewLibraryLaw"]} */ law) => post(path.library, law);

/** @returns {Promise<Schemas["LibraryLawRemoved"]>} */
export const removeFromLibrary = (/** @type {string} */ name) => remove(`${path.library}/${name}`);

/** @returns {Promise<Schemas["CalibrationCreated"]>} */
export const discover = (/** @type {number} */ id) => post(`${calibration(id)}/discovery`);

/** @returns {Promise<Schemas["CalibrationCreated"]>} */
export const whatIf = (/** @type {number} */ id, /** @type {string[]} */ without) =>
  post(`${calibration(id)}/what-if`, { without });

/** @returns {Promise<Schemas["RunsAdded"]>} */
export const addRuns = (/** @type {number} */ id, /** @type {string} */ runs, /** @type {number} */ calibration) =>
  post(`${study(id)}/runs`, { runs, calibration });

/** @returns {Promise<Schemas["StudyArchived"]>} */
export const archive = (/** @type {number} */ id, /** @type {"archive" | "restore"} */ verb) =>
  post(`${study(id)}/${verb}`);

/** @returns {Promise<Schemas["StudyDeleted"]>} */
export const deleteStudy = (/** @type {number} */ id) => remove(study(id));

/** @returns {Promise<Schemas["ExperimentCreated"]>} */
export const addExperiment = (/** @type {Schemas["NewExperiment"]} */ experiment) =>
  post("/v1/experiments", experiment);

/** @returns {Promise<Schemas["CalibrationCreated"]>} */
export const submit = (/** @type {Schemas["NewCalibration"]} */ job) => post("/v1/calibrations", job);

/**
 * The files that a study was submitted with, as a draft.
 * @returns {Promise<{ name: string, files: Record<string, string> }>}
 */
export async function filesOfStudy(/** @type {string} */ id) {
  const { name, calibrations } = await get(path.study(Number(id)));
  const job = await get(path.job(calibrations[0]));
  const experiment = await get(path.experiment(job.experiment));
  return {
    name,
    files: { "job.toml": job.toml, "experiment.toml": experiment.toml, ...experiment.files, ...job.files },
  };
}

/** @returns {Promise<Schemas["Guess"]>} */
export const guessImport = (/** @type {Schemas["GuessRequest"]} */ table) => post("/v1/import/guess", table);

/** @returns {Promise<Schemas["Converted"]>} */
export const importTable = (/** @type {Schemas["ImportRequest"]} */ table) => post("/v1/import", table);
