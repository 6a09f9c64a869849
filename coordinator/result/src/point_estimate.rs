//! The result of a fit or a search: the most probable parameters, for a summary.

use std::collections::BTreeMap;

use inference::point_estimate::{Generation, StopReason};
use job::{AlgorithmName, FreeParameter};
use record::EstimateRow;

use crate::error_summary::{BaselineSummary, CorrectedSummary, ErrorSummary};
use crate::finished_calibration::FinishedCalibration;
use crate::holdout_summary::HoldoutSummary;
use crate::table::fixed_sigma::FixedSigmas;
use crate::table::holdout_errors::HoldoutErrors;

/// The result of a fit or a search.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PointEstimate {
    /// The calibration that it is of; 0 in results of earlier versions.
    #[serde(default)]
    pub calibration: i64,
    /// Name of the algorithm.
    #[schema(value_type = String)]
    pub algorithm: AlgorithmName,
    /// The most probable parameters by name.
    pub parameters: BTreeMap<String, f64>,
    /// Standard deviations of the Laplace approximation by name; null at a bound, and for a parameter that neither data nor prior
    /// determine. Null for a search by generations, which does not estimate the curvature.
    pub sd: Option<BTreeMap<String, Option<f64>>>,
    /// The parameters that lie at a bound of their prior.
    pub at_bound: Vec<String>,
    /// Log-likelihood plus log-density of the prior, both normalised.
    pub log_posterior: f64,
    /// Errors of the model at these parameters.
    pub error: ErrorSummary,
    /// Errors of the model on the holdout runs by group; groups without a run are left out.
    #[serde(default)]
    pub holdout_groups: Vec<HoldoutSummary>,
    /// Errors of interpolation without physics.
    pub baseline: BaselineSummary,
    /// Errors of the corrected predictions.
    pub corrected: CorrectedSummary,
    /// Number of evaluations.
    pub evaluations: u64,
    /// Number of evaluations that the model rejected.
    pub rejected: u64,
    /// Wall time `[s]`.
    pub wall_s: f64,
    /// Reason for stopping: `decrease` (no step can improve the posterior by more than the tolerance), `step` (no tried step improves the posterior), `budget`;
    /// for a search by generations `stagnation` (many generations without improvement), `generations`, `budget`.
    #[schema(value_type = String)]
    pub stop: StopReason,
    /// Convergence of a search by generations; empty for a fit.
    pub history: Vec<GenerationSummary>,
}

/// State of a search after a generation.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct GenerationSummary {
    /// Number of evaluations so far.
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
    /// Most probable value of the parameter, in its unit.
    pub value: f64,
    /// Standard deviation of the parameter by the Laplace approximation, in its unit; `None` if nothing determines it.
    pub sd: Option<f64>,
    /// Whether the parameter lies at a bound of its prior.
    pub at_bound: bool,
}

/// Returns the convergence of a search by generations.
pub fn generations(history: &[Generation]) -> Vec<GenerationSummary> {
    let generation = |g: &Generation| GenerationSummary {
        evaluations: g.evaluations,
        best: g.best,
        mean: g.mean,
    };
    history.iter().map(generation).collect()
}

/// Returns the parameters of an estimate, in the order of the job.
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
    /// Returns the estimate with its errors in the noise sds of its study.
    #[must_use]
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        PointEstimate {
            baseline: self.baseline.in_fixed_sigmas(sigmas),
            corrected: self.corrected.in_fixed_sigmas(sigmas),
            error: self.error.in_fixed_sigmas(sigmas),
            holdout_groups: HoldoutSummary::all_in_fixed_sigmas(self.holdout_groups, sigmas),
            ..self
        }
    }
}

impl FinishedCalibration {
    /// Returns the result of a fit, with or without draws, or of a search; `None` for a sample.
    pub fn point_estimate(&self) -> Option<PointEstimate> {
        let estimate = self.mode()?;
        let comparison = self.comparison();
        let fitted = || fitted(estimate, &self.spec.parameters);
        let name = |p: FittedParameter| p.free.name.clone();
        Some(PointEstimate {
            calibration: self.row.id,
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
            holdout_groups: HoldoutSummary::all(HoldoutErrors::of_model(comparison.rows.iter())),
            evaluations: self.row.evaluations.unwrap_or(0),
            rejected: self.row.rejected.unwrap_or(0),
            wall_s: self.row.busy_ms as f64 / 1000.0,
            stop: estimate.stop,
            history: generations(&estimate.history),
        })
    }
}
