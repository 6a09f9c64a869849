//! `summary.json`: the contract's summary of a study.

use std::collections::BTreeMap;

use inference::diagnostics;
use shared::channel::Channel;

use super::comparison::{Comparison, ComparisonRow};
use super::coverage::Coverage;
use super::discovery::DiscoverySummary;
use super::errors::ErrorTable;
use super::flags::Flag;
use super::point_estimate::PointEstimate;
use super::{FinishedCalibration, prior_mean};

/// The summary of a study; what does not apply is null.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Summary {
    /// Name of the experiment.
    pub experiment: String,
    /// Seed of the job.
    pub seed: u64,
    /// Version of the equations and the effects.
    pub model_version: String,
    /// `quasi_static` or `scm`.
    pub model_kind: String,
    /// State of the study.
    pub status: String,
    /// The error ledger: base first, then each extension. Empty for a fit, which has no posterior.
    pub calibrations: Vec<CalibrationSummary>,
    /// Deterministic fits.
    pub point_estimates: Vec<PointEstimate>,
    /// What deserves attention.
    pub flags: Vec<Flag>,
    /// What is known of effects that the model misses; null where no search is finished.
    pub discovery: Option<DiscoverySummary>,
}

/// A calibration of the ledger.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CalibrationSummary {
    /// Effects switched on.
    pub effects: Vec<String>,
    /// Algorithm.
    pub algorithm: String,
    /// Log-evidence.
    pub log_evidence: Option<f64>,
    /// Its standard error.
    pub log_evidence_se: Option<f64>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Evaluations of the sampler.
    pub evaluations: Option<u64>,
    /// Of these, refused by the model.
    pub rejected: Option<u64>,
    /// Wall time `[s]`.
    pub wall_s: f64,
    /// What a metamodel did between evaluations; null without one.
    pub metamodel: Option<MetamodelSummary>,
    /// Stages.
    pub stages: Vec<StageSummary>,
    /// Parameters by name.
    pub parameters: BTreeMap<String, ParameterSummary>,
    /// Interpolation without physics.
    pub baseline: BaselineSummary,
    /// Errors of the posterior-mean prediction.
    pub error: ErrorSummary,
    /// Noise standard deviation by channel: declared, or its posterior mean.
    pub noise_sd: BTreeMap<String, f64>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
}

/// What a metamodel did between evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct MetamodelSummary {
    /// Moves that it proposed, each an evaluation of `quasi_static` in place of one of `scm`.
    pub moves: u64,
    /// Subchains of such moves.
    pub subchains: u64,
    /// Of these, the ones that ended elsewhere than they began, where `scm` was asked.
    pub moved: u64,
}

/// A stage.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StageSummary {
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Acceptance rate.
    pub acceptance: f64,
    /// Drift as a z-score.
    pub drift_z: f64,
    /// Moves per particle.
    pub steps: u32,
}

/// A parameter after and before the data.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ParameterSummary {
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
    /// 5 % quantile.
    pub q05: f64,
    /// Median.
    pub q50: f64,
    /// 95 % quantile.
    pub q95: f64,
    /// Value of the most probable particle.
    pub map: f64,
    /// Prior mean.
    pub prior_mean: Option<f64>,
    /// Prior standard deviation.
    pub prior_sd: Option<f64>,
    /// Whether q05 or q95 lies within 2 % of the range of a bound.
    pub at_bound: bool,
}

/// Errors on both kinds of runs.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ErrorSummary {
    /// Fitted runs.
    pub fit: Option<ErrorTable>,
    /// Runs that were not fitted.
    pub holdout: Option<ErrorTable>,
}

/// Interpolation without physics.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct BaselineSummary {
    /// `interpolation`: monotone cubic in slip between the fitted measurements of the same wheel.
    pub name: String,
    /// Its errors.
    pub holdout: Option<ErrorTable>,
}

impl BaselineSummary {
    pub(super) fn of(comparison: &Comparison) -> Self {
        BaselineSummary {
            name: "interpolation".into(),
            holdout: comparison.baseline_holdout.clone(),
        }
    }
}

/// Coverage on both kinds of runs.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CoverageSummary {
    /// Fitted runs.
    pub fit: Option<f64>,
    /// Runs that were not fitted.
    pub holdout: Option<f64>,
}

impl FinishedCalibration {
    /// Names of the effects of its model.
    pub fn effects(&self) -> Vec<String> {
        let effects = &self.spec.fit_variant.effects;
        effects.iter().map(|e| e.name.clone()).collect()
    }

    /// The calibration's line of the ledger; `None` for a fit: point estimates stand apart.
    pub fn calibration_summary(&self) -> Option<CalibrationSummary> {
        if self.estimate.is_some() {
            return None;
        }
        let comparison = self.comparison();
        let noise_sd = Channel::ALL
            .iter()
            .filter_map(|c| {
                let rows = comparison
                    .rows
                    .iter()
                    .filter(|r| r.usage == "fit" && r.channel == c.name());
                let sds: Vec<f64> = rows.filter_map(|r| r.noise_sd).collect();
                Some((c.name().to_owned(), diagnostics::mean(&sds)?))
            })
            .collect();
        Some(CalibrationSummary {
            effects: self.effects(),
            algorithm: self.spec.method.name().to_owned(),
            log_evidence: self.row.log_evidence,
            log_evidence_se: self.row.log_evidence_se,
            equilibrated: self.row.equilibrated,
            evaluations: self.row.evaluations,
            rejected: self.row.rejected,
            wall_s: self.row.busy_ms as f64 / 1000.0,
            metamodel: self.subchains.map(|s| MetamodelSummary {
                moves: s.moves,
                subchains: s.subchains,
                moved: s.moved,
            }),
            stages: self
                .stages
                .iter()
                .map(|s| StageSummary {
                    tempering_exponent: s.tempering_exponent,
                    acceptance: s.acceptance,
                    drift_z: s.drift_z,
                    steps: s.steps,
                })
                .collect(),
            parameters: self.parameter_summaries().into_iter().collect(),
            baseline: BaselineSummary::of(&comparison),
            noise_sd,
            coverage90: CoverageSummary {
                fit: coverage(&comparison.rows, "fit"),
                holdout: coverage(&comparison.rows, "holdout"),
            },
            error: ErrorSummary {
                fit: comparison.fit,
                holdout: comparison.holdout,
            },
        })
    }

    /// Every parameter after and before the data, in the order of the job.
    pub fn parameter_summaries(&self) -> Vec<(String, ParameterSummary)> {
        let best = self.most_probable();
        let finite = |x: f64| x.is_finite().then_some(x);
        self.spec
            .parameters
            .iter()
            .enumerate()
            .filter_map(|(i, parameter)| {
                let draws = diagnostics::summary(&self.draws(i))?;
                let summary = ParameterSummary {
                    mean: draws.mean,
                    sd: draws.sd,
                    q05: draws.q05,
                    q50: draws.q50,
                    q95: draws.q95,
                    map: best?.theta[i],
                    prior_mean: finite(prior_mean(&parameter.marginal)),
                    prior_sd: finite(parameter.marginal.sd()),
                    at_bound: parameter.marginal.at_bound(draws.q05, draws.q95),
                };
                Some((parameter.name.clone(), summary))
            })
            .collect()
    }
}

fn coverage(rows: &[ComparisonRow], usage: &str) -> Option<f64> {
    let coverage = Coverage::count(rows.iter().filter(|r| r.usage == usage))?;
    Some(coverage.inside as f64 / coverage.of as f64)
}
