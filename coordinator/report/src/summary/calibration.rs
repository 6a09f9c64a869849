//! A calibration in `summary.json`: a line of the error ledger.

use std::collections::BTreeMap;

use inference::diagnostics;
use job::AlgorithmName;
use shared::channel::Channel;
use shared::experiment::RunUse;

use super::response_surface::ResponseSurfaceSummary;
use result::coverage_summary::CoverageSummary;
use result::diagnostics::emulator::{emulator, numerical_noise};
use result::error_summary::{BaselineSummary, CorrectedSummary, ErrorSummary};
use result::finished_calibration::FinishedCalibration;
use result::holdout_summary::HoldoutSummary;
use result::parameter_summary::ParameterSummary;
use result::table::coverage::Coverage;
use result::table::fixed_sigma::FixedSigmas;
use result::table::holdout_errors::HoldoutErrors;
use result::table::row::rows_of;
use result::table::transient_errors::TransientErrors;

/// A line of the error ledger.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CalibrationSummary {
    /// Id of the calibration.
    pub calibration: i64,
    /// Number of its set of runs in the study, from 1. Errors and evidence of lines with different sets are not comparable.
    pub data_set: usize,
    /// Number of fitted runs.
    pub fitted_runs: usize,
    /// Number of holdout runs.
    pub held_out_runs: usize,
    /// Effects of the model.
    pub effects: Vec<String>,
    /// Name of the algorithm.
    #[schema(value_type = String)]
    pub algorithm: AlgorithmName,
    /// Whether draws, intervals and evidence are those of a normal approximation about a fit.
    pub normal_approximation: bool,
    /// Log-evidence `[nats]`.
    pub log_evidence: Option<f64>,
    /// Standard error of the log-evidence; null for a normal approximation.
    pub log_evidence_se: Option<f64>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Number of evaluations.
    pub evaluations: Option<u64>,
    /// Number of evaluations that the model rejected.
    pub rejected: Option<u64>,
    /// Wall time `[s]`.
    pub wall_s: f64,
    /// The emulator that the sampler drew on; null without one.
    #[serde(default)]
    pub emulator: Option<EmulatorSummary>,
    /// Scatter of the model that counts as noise, by channel, in the unit of the channel; empty for a smooth model.
    #[serde(default)]
    pub numerical_noise: BTreeMap<String, f64>,
    /// The response surface of the model's outputs over the posterior; null if the draws do not determine one.
    #[serde(default)]
    pub response_surface: Option<ResponseSurfaceSummary>,
    /// Stages of the sampler; empty for a fit.
    pub stages: Vec<StageSummary>,
    /// Parameters by name.
    pub parameters: BTreeMap<String, ParameterSummary>,
    /// Errors of interpolation without physics.
    pub baseline: BaselineSummary,
    /// Errors of the corrected predictions.
    pub corrected: CorrectedSummary,
    /// Errors of the posterior-mean prediction.
    pub error: ErrorSummary,
    /// Errors of the posterior-mean prediction of the holdout runs by group; groups without a run are left out.
    #[serde(default)]
    pub holdout_groups: Vec<HoldoutSummary>,
    /// Errors of the sinkage before the steady state by group of runs; empty if the job fits no histories.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transient_errors: Vec<TransientErrors>,
    /// Noise standard deviation by channel: declared, or its posterior mean.
    pub noise_sd: BTreeMap<String, f64>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
}

/// The emulator of a sampler.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct EmulatorSummary {
    /// Number of batches that refined or confirmed the emulator.
    pub rounds: usize,
    /// Number of evaluations of the model, final draws and rejected ones included.
    pub evaluations: u64,
    /// Root mean square error of the outputs at the last batch, in error standard deviations.
    pub error_sigma: Option<f64>,
    /// Effective share of the final draws; null if the emulator was given up.
    pub effective_share: Option<f64>,
    /// Whether the emulator was given up, so that the model itself was sampled.
    pub fell_back: bool,
}

impl EmulatorSummary {
    fn new(calibration: &FinishedCalibration) -> Option<Self> {
        let diagnostics = emulator(calibration)?;
        Some(EmulatorSummary {
            rounds: diagnostics.rounds.len(),
            evaluations: calibration.row.evaluations.unwrap_or_default(),
            error_sigma: diagnostics.error_sigma(),
            effective_share: diagnostics.effective_share(),
            fell_back: diagnostics.fell_back,
        })
    }
}

/// A stage of the sampler.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StageSummary {
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Acceptance rate of the moves.
    pub acceptance: f64,
    /// Drift of the log-likelihood during the moves, as a z-score.
    pub drift_z: f64,
    /// Moves per particle.
    pub steps: u32,
}

impl CalibrationSummary {
    /// Returns the line with its errors in the given noise standard deviations.
    #[must_use]
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        CalibrationSummary {
            baseline: self.baseline.in_fixed_sigmas(sigmas),
            corrected: self.corrected.in_fixed_sigmas(sigmas),
            error: self.error.in_fixed_sigmas(sigmas),
            holdout_groups: HoldoutSummary::all_in_fixed_sigmas(self.holdout_groups, sigmas),
            ..self
        }
    }
}

/// Summarises a calibration for the ledger; `None` without draws, because point estimates are listed separately.
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
        emulator: EmulatorSummary::new(calibration),
        numerical_noise: calibration
            .emulator
            .as_ref()
            .map(numerical_noise)
            .unwrap_or_default(),
        response_surface: calibration.response_surface().as_ref().map(Into::into),
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
        holdout_groups: HoldoutSummary::all(HoldoutErrors::of_model(comparison.rows.iter())),
        transient_errors: TransientErrors::by_group(&calibration.predicted_transients(comparison)),
    })
}
