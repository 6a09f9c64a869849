//! The records of a sampler: finished stages, the stage in progress, the posterior sample.

use super::particle::Particle;

/// A finished stage.
#[derive(Debug, Clone, PartialEq)]
pub struct StageRecord {
    /// Index from 1; the prior draws are stage 0 and have no record.
    pub stage: usize,
    /// The likelihood's power in this stage's target.
    pub tempering_exponent: f64,
    /// Share of the proposals accepted, those outside the prior counted as rejected; in a stage of draws, ESS/N.
    pub acceptance: f64,
    /// z-score of the mean change of the log-likelihood over the moves; large in size: not in equilibrium. In a stage of draws,
    /// z-score of the difference between its means at this exponent over these draws and over those of the stage before.
    pub drift_z: f64,
    /// z-score of the mean change of exp(step l), step being the growth of the exponent that led here: sensitive to the best
    /// particles, where `drift_z` is dominated by the worst. In a stage of draws, z-score of the difference of the log-evidence.
    pub weight_drift_z: f64,
    /// Rank correlation of the log-likelihoods before and after the moves; 0 in a stage of draws.
    pub correlation: f64,
    /// Steps per particle (in Ching and Chen, of the longest chain); rounds of draws.
    pub steps: usize,
    /// ln Z(this exponent) - ln Z(the last); the first also holds the surviving fraction of the prior draws.
    pub log_evidence_increment: f64,
    /// Coefficient of variation of the incremental weights that led to this stage; in a stage of draws, of their weights.
    pub weight_cov: f64,
    /// Particles / (1 + `weight_cov`^2); effective sample size of the draws.
    pub ess: f64,
    /// Scale of the proposals at the end; 0 in a stage of draws.
    pub scale: f64,
    /// Number of evaluations in this stage.
    pub evaluations: u64,
    /// Whether drift and correlation show that the stage reached its target; of stages of draws, only the last is judged.
    pub equilibrated: bool,
    /// The population after the moves, equally weighted.
    pub population: Vec<Particle>,
}

/// The stage in progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageProgress {
    /// Index of the stage; 0 during the prior draws.
    pub stage: usize,
    /// Tempering exponent of the stage.
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
    /// Log-evidence, ln p(data).
    pub log_evidence: f64,
    /// Standard error of the log-evidence within the run.
    pub log_evidence_se: f64,
    /// The `drift_z` of the stages of moves taken together: their sum / sqrt(number of stages); that of the last stage, if it was
    /// drawn.
    pub drift_z: f64,
    /// The `weight_drift_z` of the stages taken together, in the same way.
    pub weight_drift_z: f64,
    /// Whether every stage reached its target and the drifts taken together stay below 3 in size (6 if the last stage was drawn);
    /// if not, neither draws nor evidence can be trusted.
    pub equilibrated: bool,
    /// Number of evaluations.
    pub evaluations: u64,
    /// Number of evaluations that the model rejected.
    pub rejected: u64,
}
