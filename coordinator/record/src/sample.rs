//! Results of a sampler: stages, draws, predictions.

use std::collections::BTreeMap;

use shared::outcome::Observables;

/// A stored stage, without its population.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StageRow {
    /// Position, counted from 0 = the prior.
    pub stage: u32,
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Acceptance rate of the moves; of independent draws, their effective share.
    pub acceptance: f64,
    /// Drift of the mean log-likelihood during the moves, or from the last stage's draws to this one's, as a z-score.
    pub drift_z: f64,
    /// Rank correlation of the log-likelihood between start and end of the moves; 0 of draws.
    pub correlation: f64,
    /// Moves per particle; rounds of draws.
    pub steps: u32,
    /// Share of the log-evidence.
    pub log_evidence_increment: f64,
    /// Coefficient of variation of the weights.
    pub weight_cov: f64,
    /// Effective sample size of the weights.
    pub ess: f64,
    /// Scale of the proposals at the end; 0: the stage was drawn.
    pub scale: f64,
    /// Evaluations spent.
    pub evaluations: u64,
    /// Whether the moves reached equilibrium, or the last draws agree with those before.
    pub equilibrated: bool,
}

/// Why the model rejected a parameter vector: its kind, a colon, the details.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RejectionReason(pub String);

impl RejectionReason {
    /// The part before the colon.
    pub fn kind(&self) -> &str {
        self.0.split_once(':').map_or(&self.0, |(kind, _)| kind)
    }
}

/// A draw from the prior that a sampler began with.
#[derive(Debug, Clone, PartialEq)]
pub struct PriorDraw {
    /// Parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// The predicted values that the likelihood takes, or why the model rejected.
    pub result: Result<Vec<f64>, RejectionReason>,
    /// Leases of it that failed before one succeeded.
    pub faults: u64,
}

/// A final draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// Observables of the fitted runs, or why the model rejected.
    pub fit: Result<Observables, RejectionReason>,
    /// The holdout runs, where there are any.
    pub holdout: Option<HoldoutPrediction>,
}

/// What the model says of the holdout runs at a final draw.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldoutPrediction {
    /// Observables of all of them, or why the model rejected one.
    pub together: Result<Observables, RejectionReason>,
    /// Where it rejected one of several: each by itself, by position among them.
    pub alone: BTreeMap<usize, Result<Observables, RejectionReason>>,
}

impl HoldoutPrediction {
    /// The observables in which a run stands, with its place in them, or why the model rejected it.
    ///
    /// # Arguments
    /// - `position`: the run's among the holdout runs.
    ///
    /// # Errors
    /// The reason: its own, or where it was not asked for alone that of all.
    pub fn run(&self, position: usize) -> Result<(&Observables, usize), &RejectionReason> {
        match (&self.together, self.alone.get(&position)) {
            (Ok(observables), _) => Ok((observables, position)),
            (Err(_), Some(Ok(observables))) => Ok((observables, 0)),
            (Err(_), Some(Err(reason))) | (Err(reason), None) => Err(reason),
        }
    }
}

impl From<Result<Observables, RejectionReason>> for HoldoutPrediction {
    fn from(together: Result<Observables, RejectionReason>) -> Self {
        HoldoutPrediction {
            together,
            alone: BTreeMap::new(),
        }
    }
}

/// Counts of a metamodel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Subchains {
    /// Requested subchains.
    pub subchains: u64,
    /// Moves that they proposed.
    pub moves: u64,
    /// Subchains that moved, so that the model was evaluated at their end.
    pub moved: u64,
}
