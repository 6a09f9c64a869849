//! What a sampler leaves: its stages, its draws, and what the model predicts at them.

use shared::outcome::Observables;

/// A stored stage, without its population.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StageRow {
    /// Position, counted from 0 = the prior.
    pub stage: u32,
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Acceptance rate of the moves.
    pub acceptance: f64,
    /// Drift of the mean log-likelihood during the moves, as a z-score.
    pub drift_z: f64,
    /// Rank correlation of the log-likelihood between start and end of the moves.
    pub correlation: f64,
    /// Moves per particle.
    pub steps: u32,
    /// Share of the log-evidence.
    pub log_evidence_increment: f64,
    /// Coefficient of variation of the incremental weights.
    pub weight_cov: f64,
    /// Effective sample size of the weights.
    pub ess: f64,
    /// Scale of the proposals at the end.
    pub scale: f64,
    /// Evaluations spent.
    pub evaluations: u64,
    /// Whether the moves reached equilibrium.
    pub equilibrated: bool,
}

/// A particle of a stored population.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Sample {
    /// Parameter vector.
    pub theta: Vec<f64>,
    /// Log-likelihood; `None` where the model refused.
    pub log_likelihood: Option<f64>,
    /// Log-density of the prior.
    pub log_prior: f64,
}

/// A draw from the prior that a sampler began with.
#[derive(Debug, Clone, PartialEq)]
pub struct PriorDraw {
    /// Parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// The predicted values that the likelihood takes, or why the model refused.
    pub result: Result<Vec<f64>, String>,
    /// Leases of it that failed before one succeeded.
    pub faults: u64,
}

/// A final draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// What the model gave for the fitted runs, or why it refused.
    pub fit: Result<Observables, String>,
    /// The same for the holdout runs, where there are any.
    pub holdout: Option<Result<Observables, String>>,
}

/// What a metamodel did between evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Subchains {
    /// Subchains that were asked for.
    pub subchains: u64,
    /// Moves that they proposed.
    pub moves: u64,
    /// Subchains that ended elsewhere, where the model was asked.
    pub moved: u64,
}
