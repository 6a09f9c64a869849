//! What a search for a missing effect found: stored as it stands here, shown in summary, report and terminal.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use job::effect_name;

/// Name of the explanation that nothing is missing.
pub const NONE: &str = "none";
/// Name of the explanation that something is missing that no effect of the library is like.
pub const NOT_IN_LIBRARY: &str = "not_in_library";
/// Most test runs that are proposed.
pub const NEXT_RUNS: usize = 3;

/// What can be said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No explanation beats the model as it is by 3 nats.
    NothingDetectable,
    /// One effect has more than nine tenths of the probability.
    Named,
    /// Effects that these data cannot tell apart have it together.
    Class,
    /// Something acts that no effect of the library is like; where and on what is known.
    NotInLibrary,
    /// Something is missing; which of several explanations, or what at all, the data do not say.
    Undecided,
}

/// A search of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Discovery {
    /// The effects that the model had.
    pub given: Vec<String>,
    /// What can be said.
    pub verdict: Verdict,
    /// The same as a sentence for a test engineer.
    pub text: String,
    /// What would be added to the model; only where one thing can be named.
    pub extension: Option<Extension>,
    /// Effects of the model that it no longer gains by.
    pub drop: Vec<String>,
    /// Every explanation by falling probability, with `none` and, where it was looked for, `not_in_library`.
    pub effects: Vec<JudgedEffect>,
    /// What acts, where no effect of the library does.
    pub outside: Option<Outside>,
    /// Effects that these data could not show at their usual strength.
    pub cannot_exclude: Vec<String>,
    /// Effects that the model refused at every strength.
    pub refused: Vec<String>,
    /// Test runs that would tell the remaining explanations apart, the best first.
    pub next_runs: Vec<NextRun>,
    /// Tests without a rolling wheel that would.
    pub other_tests: Vec<String>,
    /// How well the model fits as it is, and with the best explanation.
    pub chi2: ChiSquare,
    /// The same with the best explanation.
    pub chi2_best: ChiSquare,
    /// Evaluations until the effect had a name.
    pub evaluations_to_name: u64,
    /// All evaluations.
    pub evaluations: u64,
}

/// What is added to a model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Extension {
    /// An effect of the catalogue.
    Effect(String),
    /// An effect of the catalogue on one wheel of several.
    OnWheel {
        /// The effect.
        effect: String,
        /// The wheel.
        wheel: String,
    },
    /// An effect file: its name and its text.
    File {
        /// Its name.
        name: String,
        /// Its text.
        text: String,
    },
}

/// One explanation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct JudgedEffect {
    /// The effect, `EFFECT.WHEEL` on one wheel of several; or `none`, or `not_in_library`.
    pub name: String,
    /// Log-evidence over that of the model as it is \[nats\].
    pub log_bayes_factor: f64,
    /// Probability among all explanations.
    pub probability: f64,
    /// Explanations that these data cannot tell apart have the same; 0 is `none`.
    pub class: u32,
    /// Whether its class belongs to the least set that holds the truth with 95 % probability.
    pub in_credible_set: bool,
    /// The prior of its strength, as its file has it.
    pub strength_prior: Option<String>,
    /// Its own most probable parameters, SI.
    pub parameters: BTreeMap<String, f64>,
    /// How the evidence was computed: `screen`, `rank_one`, `polished`, `confirmed` or `sampled`.
    pub method: String,
}

/// What acts outside the library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Outside {
    /// `pressure`, `shear`, `drawbar_pull`, `torque` or `sinkage`.
    pub acts_on: String,
    /// `z`, `v_n`, `v_t`, `j`, `position`, `slip`, `sled_speed`, `wheel_load` or `sinkage`.
    pub depends_on: String,
    /// The form of the dependence: `step`, `power`, ..., or `spline`.
    pub form: String,
    /// Log-evidence over that of the model as it is \[nats\].
    pub log_bayes_factor: f64,
    /// The effect file, ready to be added.
    pub effect_file: String,
    /// The factor on what it acts on (of a channel: what is added) along what it depends on.
    pub curve: Vec<[f64; 2]>,
    /// Log predictive density of left-out levels over that of the model as it is, and of the best of the library \[nats\].
    pub left_out_nats: [f64; 2],
}

/// A proposed test run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct NextRun {
    /// Slip.
    pub slip: f64,
    /// Wheel load.
    pub wheel_load_n: f64,
    /// Sled speed.
    pub sled_speed_m_s: f64,
    /// The explanations that it tells apart.
    pub separates: Vec<String>,
    /// Expected information on which of them holds.
    pub information_nats: f64,
}

/// Squared residuals in units of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ChiSquare {
    /// Their sum; null where the noise was inferred from them.
    pub value: Option<f64>,
    /// Data less what was fitted.
    pub degrees_of_freedom: f64,
    /// Probability of as much by chance.
    pub p: Option<f64>,
}

/// The name of the effect that an extension adds.
pub fn effect_of(extension: &Extension) -> String {
    match extension {
        Extension::Effect(effect) | Extension::OnWheel { effect, .. } => effect.clone(),
        Extension::File { name, text } => effect_name(text).unwrap_or_else(|| name.clone()),
    }
}
