//! The messages between a user and the service.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray};
use utoipa::ToSchema;

/// `POST /v1/experiments`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewExperiment {
    /// Text of `experiment.toml`.
    pub toml: String,
    /// Texts of the files that it names.
    #[serde(default)]
    pub files: BTreeMap<String, String>,
}

/// `POST /v1/calibrations`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewCalibration {
    /// The experiment's id; it takes the place of the job file's `experiment`.
    pub experiment: i64,
    /// Text of `job.toml`.
    pub toml: String,
    /// Texts of the files that it names (its effect files).
    #[serde(default)]
    pub files: BTreeMap<String, String>,
    /// A name for lists.
    #[serde(default)]
    pub name: Option<String>,
    /// URL that the pauses and ends of the study's calibrations are posted to, of a host that the service lists.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub webhook: Option<String>,
}

/// Answer to a new experiment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct ExperimentCreated {
    /// Id of the experiment.
    pub id: i64,
}

/// Answer to a new calibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct CalibrationCreated {
    /// Id of the calibration.
    pub id: i64,
    /// The study that the calibration opens.
    pub study: i64,
    /// Ids of the point estimates that the job requests beside the sample.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub point_estimates: Vec<i64>,
}

/// `POST /v1/calibrations/ID/extend`: an effect of the catalogue, or an effect file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewExtension {
    /// An effect of the catalogue.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effect: Option<String>,
    /// Acts on this wheel alone, of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel: Option<String>,
    /// A user's own effect file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effect_file: Option<NamedText>,
}

/// `POST /v1/effects`: an effect file, or the same as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewEffect {
    /// The text of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// The keys of the file as an object; parameters count in the order of their names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Object>)]
    pub effect: Option<toml::Table>,
}

/// `POST /v1/library`: a law that every later search tries, by its file or by the search that found it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewLibraryLaw {
    /// The text of an effect file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// The calibration whose search found the law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<i64>,
    /// The law of the search, by the name of its effect; without it, the one that the search would add.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// The name that it gets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// `DELETE /v1/library/NAME`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct LibraryLawRemoved {
    /// The law.
    pub name: String,
}

/// A file with its name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NamedText {
    /// Name without folders.
    pub name: String,
    /// Content of the file.
    pub text: String,
}

/// `POST /v1/studies/ID/runs`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewRuns {
    /// Rows with a header, as in `runs.csv`.
    pub runs: String,
    /// The calibration of the study whose model is fitted to all runs; by default, the last one of the ledger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<i64>,
}

/// `POST /v1/calibrations/ID/follow`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewFollow {
    /// All further rows so far with a header, as in `runs.csv`.
    pub runs: String,
    /// The largest number of evaluations of the search for what is missing; by default, 100,000 of a model in steady motion and 2,000 of any
    /// other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_evaluations: Option<usize>,
}

/// `POST /v1/calibrations/ID/what-if`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct WhatIf {
    /// Names of fitted runs that are held out.
    pub without: Vec<String>,
}

/// `POST /v1/calibrations/ID/predict`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NewPrediction {
    /// Rows of the conditions to predict, with the columns of a plan: CSV text. Without one, a sweep starts from the medians of the fitted
    /// runs.
    pub plan: Option<String>,
    /// One quantity in evenly spaced values for every row: `NAME=FROM:TO:COUNT`.
    pub sweep: Option<String>,
    /// Wheels that the experiment does not have: TOML text with tables `[wheel.NAME]`.
    pub wheels: Option<String>,
    /// Statements whose probabilities are asked for, as in `drawbar_pull_n > 12`; at most 50.
    pub statements: Vec<String>,
    /// Number of draws of each model, at most those that predict held-out runs.
    pub draws: Option<usize>,
}

/// `POST /v1/calibrations/ID/decide`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NewDecision {
    /// Text of a TOML file with a table `[decision]`, and perhaps wheels; by default, the job of the calibration.
    pub file: Option<String>,
    /// Number of draws of each model, at most those that predict held-out runs.
    pub draws: Option<usize>,
}

/// `POST /v1/calibrations/ID/stream`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NewRecording {
    /// Samples at 10 Hz: CSV text with `t_s`, `slip` and measured channels; `wheel_load_n`, `sled_speed_m_s` and `slip_angle_deg` where they
    /// are not those of the fitted runs.
    pub recording: String,
    /// Wheel, if the fitted runs have several.
    pub wheel: Option<String>,
    /// Parameters that may vary; by default, those of the soil.
    pub parameters: Vec<String>,
}

/// Answer to further runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct RunsAdded {
    /// The calibration of all runs.
    pub id: i64,
    /// Id of the study.
    pub study: i64,
    /// Id of the enlarged experiment.
    pub experiment: i64,
}

/// Answer to `POST /v1/studies/ID/archive` and `/restore`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct StudyArchived {
    /// Id of the study.
    pub id: i64,
    /// Whether lists now omit the study.
    pub archived: bool,
}

/// Answer to `POST /v1/calibrations/ID/withdraw`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Withdrawn {
    /// Id of the study.
    pub study: i64,
    /// The calibrations that are no longer part of the study, oldest first.
    pub calibrations: Vec<i64>,
}

/// Answer to `DELETE /v1/studies/ID`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct StudyDeleted {
    /// Id of the study.
    pub id: i64,
    /// The calibrations that were deleted with the study.
    pub calibrations: Vec<i64>,
}

/// The state of a calibration.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    ToSchema,
    EnumString,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum CalibrationState {
    /// No evaluation has been leased yet.
    Queued,
    /// Evaluations are being leased.
    Running,
    /// Stopped by a user, or because a machine's faults used up an evaluation's attempts.
    Paused,
    /// The calibration waits for a decision of the user.
    Waiting,
    /// The posterior is complete.
    Finished,
    /// The calibration cannot continue; the message says why.
    Failed,
    /// Stopped permanently by a user.
    Cancelled,
}

impl CalibrationState {
    /// Every state.
    pub const ALL: &'static [Self] = Self::VARIANTS;

    /// Returns the word in JSON and in the store.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Finds the state of a word.
    pub fn from_name(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// Returns whether the state is final.
    pub fn is_final(self) -> bool {
        matches!(
            self,
            CalibrationState::Finished | CalibrationState::Failed | CalibrationState::Cancelled
        )
    }
}

/// `GET /v1/calibrations/ID`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct CalibrationStatus {
    /// Id of the calibration.
    pub id: i64,
    /// Name of the calibration.
    pub name: String,
    /// The study it belongs to.
    pub study: i64,
    /// The experiment it is about.
    pub experiment: i64,
    /// State of the calibration.
    pub state: CalibrationState,
    /// Reason for which the calibration is paused or has failed.
    pub message: Option<String>,
    /// `quasi_static` or `scm`; `None` where this version does not understand the job.
    pub model_kind: Option<String>,
    /// Version of the equations, and of the effects, once the first result has pinned it.
    pub model_version: Option<String>,
    /// Live figures of the sampler; `None` before it starts.
    pub progress: Option<Progress>,
}

/// How far a calibration has come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Progress {
    /// The algorithm, as the job names it.
    pub algorithm: String,
    /// Where the algorithm is.
    pub position: Position,
    /// Parameter vectors evaluated, over all stages; of final draws their fitted runs, held-out runs not counted again.
    pub evaluations: u64,
    /// The number of these that the model rejected.
    pub rejected: u64,
    /// Evaluations of the present step that are done.
    pub step_done: u64,
    /// Evaluations of the present step.
    pub step_size: u64,
    /// The finished share of the calibration or search, from 0 to 0.99: a rough estimate from where its algorithm is.
    pub share: f64,
    /// What a search is doing, and its leaders; `None` of other algorithms.
    pub search: Option<SearchProgress>,
    /// Evaluations per second, lately.
    pub evaluations_per_s: f64,
    /// Estimated remaining time `[s]`; `None` while it is not known.
    pub remaining_s: Option<f64>,
}

/// How far a search for missing effects has come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SearchProgress {
    /// What it is doing, in words.
    pub doing: String,
    /// The most probable explanations so far, the most probable first; empty before the first effect is fitted.
    pub leaders: Vec<SearchLeader>,
}

/// An explanation that a search has fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SearchLeader {
    /// Names of its effects; empty: nothing is missing.
    pub effects: Vec<String>,
    /// Probability among all that is fitted so far. The end weighs classes and laws as well, so that it may differ.
    pub probability: f64,
}

/// Where an algorithm is, by the kind of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Position {
    /// A sampler goes through stages.
    Sampler {
        /// The present stage; 0 draws from the prior.
        stage: u32,
        /// The present tempering exponent.
        tempering_exponent: f64,
        /// Metropolis-Hastings step within the stage.
        step: u32,
        /// Acceptance rate of the present stage; `None` before its first step, and while it draws.
        acceptance: Option<f64>,
    },
    /// A fit goes in steps.
    Fit {
        /// The steps taken so far.
        steps: u32,
    },
    /// An evolution goes in generations.
    Evolution {
        /// The generations so far.
        generations: u32,
    },
    /// A search for missing effects asks in rounds.
    Search {
        /// The rounds so far.
        rounds: u32,
    },
}

/// `GET /v1/work/demand`: the amount of work, for programs that start workers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct WorkDemand {
    /// Evaluations that wait for a worker.
    pub queued: u64,
    /// Evaluations that workers hold.
    pub leased: u64,
    /// Estimated number of evaluations until all calibrations are over; from its second stage on, a calibration counts
    /// beyond the present round.
    pub evaluations_left: u64,
    /// Calibrations that are neither over nor paused.
    pub in_hand: u64,
    /// Number of workers that were heard of recently and are not quarantined.
    pub workers: u64,
    /// Number of threads of these workers.
    pub threads: u64,
    /// Mean time of an evaluation on one thread of these workers `[s]`, once there has been an evaluation.
    pub evaluation_s: Option<f64>,
    /// Results of workers that are part of a queue's job, since the service started.
    pub completed_in_queues: u64,
}

/// The body of every error response: `{"error": {"type": …, "message": …}}`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct ErrorBody {
    /// The error.
    pub error: ErrorDetail,
}

/// The error in a response.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct ErrorDetail {
    /// The type of the error.
    #[serde(rename = "type")]
    pub kind: ErrorKind,
    /// Field, value, unit, bound.
    pub message: String,
}

/// The closed list of error types.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ErrorKind {
    /// The body is not what the route takes, or the request breaks the rules of HTTP.
    InvalidBody,
    /// The body is in a form that the route does not take.
    UnsupportedMediaType,
    /// The body did not arrive in time.
    Timeout,
    /// The request names no token, or one that is not accepted.
    Unauthorized,
    /// The request comes through a foreign host or page, or its token has another role.
    Forbidden,
    /// A file in the body is malformed.
    InvalidFile,
    /// The requested resource does not exist.
    NotFound,
    /// The request does not fit the state of the thing.
    Conflict,
    /// The body is larger than the service takes.
    TooLarge,
    /// The worker speaks another version of the protocol.
    ProtocolMismatch,
    /// The service has more work than it can store, or more bodies on their way than it keeps memory for; try again later.
    Busy,
    /// Something failed inside; the log says what.
    Internal,
}
