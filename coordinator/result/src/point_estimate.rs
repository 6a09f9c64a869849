//! The result of a fit or a search: the most probable parameters.

use std::collections::BTreeMap;

use inference::point_estimate::{Generation, StopReason};
use job::{AlgorithmName, FreeParameter};
use record::EstimateRow;

use crate::error_summary::{BaselineSummary, CorrectedSummary, ErrorSummary};
use crate::finished_calibration::FinishedCalibration;
use crate::table::fixed_sigma::FixedSigmas;

/// Deterministic updating.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PointEstimate {
    /// Algorithm.
    #[schema(value_type = String)]
    pub algorithm: AlgorithmName,
    /// The most probable parameters by name.
    pub parameters: BTreeMap<String, f64>,
    /// Their standard deviations after Laplace; null at a bound, and where nothing fixes a parameter. Null for a search
    /// by generations, which does not know the curvature.
    pub sd: Option<BTreeMap<String, Option<f64>>>,
    /// The parameters that lie at a bound of their prior.
    pub at_bound: Vec<String>,
    /// Log-likelihood plus log-density of the prior, both normalised.
    pub log_posterior: f64,
    /// Errors of the model at these parameters.
    pub error: ErrorSummary,
    /// Interpolation without physics.
    pub baseline: BaselineSummary,
    /// The model with what it misses in the fitted conditions.
    pub corrected: CorrectedSummary,
    /// Evaluations spent.
    pub evaluations: u64,
    /// Of these, rejected by the model.
    pub rejected: u64,
    /// Wall time `[s]`.
    pub wall_s: f64,
    /// Why it stopped: `decrease` (no step improves the posterior), `step` (no tried step does), `budget`; of a search by
    /// generations `stagnation` (many without improvement), `generations`, `budget`.
    #[schema(value_type = String)]
    pub stop: StopReason,
    /// Convergence of a search by generations; empty for a fit.
    pub history: Vec<GenerationSummary>,
}

/// State of a search after a generation.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct GenerationSummary {
    /// Evaluations so far.
    pub evaluations: u64,
    /// Highest log-posterior so far; null while the model rejected everything.
    pub best: Option<f64>,
    /// Mean log-posterior of the generation; null if the model rejected all of it.
    pub mean: Option<f64>,
}

/// One fitted parameter.
#[derive(Debug, Clone, Copy)]
pub struct FittedParameter<'a> {
    /// The parameter as the job states it.
    pub free: &'a FreeParameter,
    /// Its most probable value, in the unit of the parameter.
    pub value: f64,
    /// Its standard deviation after Laplace, in the unit of the parameter; `None` where nothing fixes it.
    pub sd: Option<f64>,
    /// Whether it lies at a bound of its prior.
    pub at_bound: bool,
}

/// Convergence of a search by generations.
pub fn generations(history: &[Generation]) -> Vec<GenerationSummary> {
    let generation = |g: &Generation| GenerationSummary {
        evaluations: g.evaluations,
        best: g.best,
        mean: g.mean,
    };
    history.iter().map(generation).collect()
}

/// The parameters of an estimate, in the order of the job.
pub fn fitted<'a>(
    estimate: &'a EstimateRow,
    parameters: &'a [FreeParameter],
) -> impl Iterator<Item = FittedParameter<'a>> {
    parameters.iter().enumerate().map(|(i, free)| FittedParameter {
        free,
        value: estimate.theta[i],
        sd: estimate.sd.as_ref().and_then(|sd| sd[i]),
        at_bound: estimate.at_bound[i],
    })
}

impl PointEstimate {
    /// The estimate with its errors in the noise sds of its study.
    #[must_use]
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        PointEstimate {
            baseline: self.baseline.in_fixed_sigmas(sigmas),
            corrected: self.corrected.in_fixed_sigmas(sigmas),
            error: self.error.in_fixed_sigmas(sigmas),
            ..self
        }
    }
}

impl FinishedCalibration {
    /// The result of a fit, drawn from or not, or of a search; `None` of a sample.
    pub fn point_estimate(&self) -> Option<PointEstimate> {
        let estimate = self.mode()?;
        let comparison = self.comparison();
        let fitted = || fitted(estimate, &self.spec.parameters);
        let name = |p: FittedParameter| p.free.name.clone();
        Some(PointEstimate {
            algorithm: self.spec.algorithm.algorithm_name(),
            parameters: fitted().map(|p| (name(p), p.value)).collect(),
            sd: estimate
                .sd
                .is_some()
                .then(|| fitted().map(|p| (name(p), p.sd)).collect()),
            at_bound: fitted().filter(|p| p.at_bound).map(name).collect(),
            log_posterior: estimate.log_posterior(),
            baseline: BaselineSummary::new(comparison),
            corrected: CorrectedSummary::new(comparison),
            error: ErrorSummary {
                fit: comparison.fit.clone(),
                holdout: comparison.holdout.clone(),
            },
            evaluations: self.row.evaluations.unwrap_or(0),
            rejected: self.row.rejected.unwrap_or(0),
            wall_s: self.row.busy_ms as f64 / 1000.0,
            stop: estimate.stop,
            history: generations(&estimate.history),
        })
    }
}
