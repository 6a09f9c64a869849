//! The records of a sampler: finished stages, the stage in progress, the posterior sample.

use super::particle::Particle;

/// A finished stage.
#[derive(Debug, Clone, PartialEq)]
pub struct StageRecord {
    /// Index from 1; the prior draws are stage 0 and have no record.
    pub stage: usize,
    /// The likelihood's power in this stage's target.
    pub tempering_exponent: f64,
    /// Share of the proposals accepted, those outside the prior counted as rejected; of draws, their effective share.
    pub acceptance: f64,
    /// z-score of the mean change of the log-likelihood over the moves; large in size: not in equilibrium. Of draws, of the
    /// difference between its means at this exponent over these draws and over those of the stage before.
    pub drift_z: f64,
    /// The same of exp(step l), step being the growth of the exponent that led here: sensitive to the best particles,
    /// where `drift_z` is dominated by the worst. Of draws, the same of the log-evidence.
    pub weight_drift_z: f64,
    /// Rank correlation of the log-likelihoods before and after the moves; 0 of draws.
    pub correlation: f64,
    /// Steps per particle (Ching and Chen: of the longest chain); rounds of draws.
    pub steps: usize,
    /// ln Z(this exponent) - ln Z(the last); the first also holds the surviving fraction of the prior draws.
    pub log_evidence_increment: f64,
    /// Coefficient of variation of the incremental weights that led to this stage; of draws, of their own weights.
    pub weight_cov: f64,
    /// Particles / (1 + `weight_cov`^2); effective size of the draws.
    pub ess: f64,
    /// Scale of the proposals at the end; 0: the stage was drawn.
    pub scale: f64,
    /// Evaluations in this stage.
    pub evaluations: u64,
    /// Whether drift and correlation say that the stage reached its target; of a drawn stage, only the last is judged.
    pub equilibrated: bool,
    /// The population after the moves, equally weighted.
    pub population: Vec<Particle>,
}

/// The stage in progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageProgress {
    /// Index of the stage; 0 during the prior draws.
    pub stage: usize,
    /// Its tempering exponent.
    pub tempering_exponent: f64,
    /// Steps completed in this stage.
    pub step: usize,
    /// Acceptance so far; `None` before the first step and while draws are taken.
    pub acceptance: Option<f64>,
}

/// The result: a sample of the posterior, with the evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct PosteriorSample {
    /// Equally weighted draws.
    pub particles: Vec<Particle>,
    /// ln p(data).
    pub log_evidence: f64,
    /// Its standard error within the run.
    pub log_evidence_se: f64,
    /// The `drift_z` of the stages of moves taken together: their sum / sqrt(number of stages); of drawn ones, the last's.
    pub drift_z: f64,
    /// The same of `weight_drift_z`.
    pub weight_drift_z: f64,
    /// Whether every stage reached its target and the drifts taken together stay below 3 in size (of a last stage that was
    /// drawn, 6); if not, neither draws nor evidence can be trusted.
    pub equilibrated: bool,
    /// Evaluations.
    pub evaluations: u64,
    /// Those that the model rejected.
    pub rejected: u64,
}
