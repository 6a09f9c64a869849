//! A line of the error ledger in `summary.json`.

use std::collections::BTreeMap;

use inference::diagnostics;
use job::AlgorithmName;
use shared::channel::Channel;
use shared::experiment::RunUse;

use result::coverage_summary::CoverageSummary;
use result::error_summary::{BaselineSummary, CorrectedSummary, ErrorSummary};
use result::finished_calibration::FinishedCalibration;
use result::parameter_summary::ParameterSummary;
use result::table::coverage::Coverage;
use result::table::fixed_sigma::FixedSigmas;
use result::table::row::rows_of;

/// A calibration of the ledger.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CalibrationSummary {
    /// Id of the calibration.
    pub calibration: i64,
    /// Number of its set of runs in the study, from 1: errors and evidence of lines over different sets do not compare.
    pub data_set: usize,
    /// Runs that were fitted.
    pub fitted_runs: usize,
    /// Runs that were held out.
    pub held_out_runs: usize,
    /// Effects switched on.
    pub effects: Vec<String>,
    /// Algorithm.
    #[schema(value_type = String)]
    pub algorithm: AlgorithmName,
    /// Whether draws, intervals and evidence are those of a normal approximation about a fit.
    pub normal_approximation: bool,
    /// Log-evidence.
    pub log_evidence: Option<f64>,
    /// Its standard error; null of a normal approximation.
    pub log_evidence_se: Option<f64>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Evaluations of the sampler.
    pub evaluations: Option<u64>,
    /// Of these, rejected by the model.
    pub rejected: Option<u64>,
    /// Wall time `[s]`.
    pub wall_s: f64,
    /// Counts of a metamodel; null without one.
    pub metamodel: Option<MetamodelSummary>,
    /// Stages.
    pub stages: Vec<StageSummary>,
    /// Parameters by name.
    pub parameters: BTreeMap<String, ParameterSummary>,
    /// Interpolation without physics.
    pub baseline: BaselineSummary,
    /// The model with what it misses in the fitted conditions.
    pub corrected: CorrectedSummary,
    /// Errors of the posterior-mean prediction.
    pub error: ErrorSummary,
    /// Noise standard deviation by channel: declared, or its posterior mean.
    pub noise_sd: BTreeMap<String, f64>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
}

/// Counts of a metamodel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct MetamodelSummary {
    /// Moves that it proposed, each an evaluation of `quasi_static` in place of one of `scm`.
    pub moves: u64,
    /// Subchains of such moves.
    pub subchains: u64,
    /// Of these, the ones that moved, so that `scm` was evaluated at their end.
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

impl CalibrationSummary {
    /// The line with its errors in the noise sds of its study.
    #[must_use]
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        CalibrationSummary {
            baseline: self.baseline.in_fixed_sigmas(sigmas),
            corrected: self.corrected.in_fixed_sigmas(sigmas),
            error: self.error.in_fixed_sigmas(sigmas),
            ..self
        }
    }
}

/// The calibration's line of the ledger; `None` without draws: point estimates stand apart.
pub fn calibration_summary(calibration: &FinishedCalibration) -> Option<CalibrationSummary> {
    if calibration.estimate().is_some() {
        return None;
    }
    let comparison = calibration.comparison();
    let noise_sd = Channel::ALL
        .iter()
        .filter_map(|c| {
            let rows = comparison
                .rows
                .iter()
                .filter(|r| r.usage == RunUse::Fit && r.channel == *c);
            let sds: Vec<f64> = rows.filter_map(|r| r.noise_sd).collect();
            Some((c.name().to_owned(), diagnostics::mean(&sds)?))
        })
        .collect();
    Some(CalibrationSummary {
        calibration: calibration.row.id,
        data_set: 1,
        fitted_runs: calibration.spec.fit_runs.len(),
        held_out_runs: calibration.spec.holdout_runs.len(),
        effects: calibration.effects(),
        algorithm: calibration.spec.algorithm.algorithm_name(),
        normal_approximation: calibration.approximated().is_some(),
        log_evidence: calibration.row.log_evidence,
        log_evidence_se: calibration.row.log_evidence_se,
        equilibrated: calibration.row.equilibrated,
        evaluations: calibration.row.evaluations,
        rejected: calibration.row.rejected,
        wall_s: calibration.row.busy_ms as f64 / 1000.0,
        metamodel: calibration.subchains().map(|s| MetamodelSummary {
            moves: s.moves,
            subchains: s.subchains,
            moved: s.moved,
        }),
        stages: calibration
            .stages()
            .iter()
            .map(|s| StageSummary {
                tempering_exponent: s.tempering_exponent,
                acceptance: s.acceptance,
                drift_z: s.drift_z,
                steps: s.steps,
            })
            .collect(),
        parameters: calibration.parameter_summaries().into_iter().collect(),
        baseline: BaselineSummary::new(comparison),
        corrected: CorrectedSummary::new(comparison),
        noise_sd,
        coverage90: CoverageSummary::from_counts(|usage| Coverage::count(rows_of(&comparison.rows, usage))),
        error: ErrorSummary {
            fit: comparison.fit.clone(),
            holdout: comparison.holdout.clone(),
        },
    })
}
