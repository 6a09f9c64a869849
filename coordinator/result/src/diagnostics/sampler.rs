//! Sampler diagnostics: equilibrium and effective sample size.

use std::collections::BTreeSet;

use record::StageRow;

use crate::finished_calibration::FinishedCalibration;

/// The diagnostics of the sampler: equilibrium and effective sample size.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct SamplerDiagnostics {
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Number of draws of the posterior.
    pub draws: usize,
    /// Number of distinct draws.
    pub distinct_draws: usize,
    /// Effective sample size of the weights that resampled the last stage, before its moves; at most `draws`.
    pub effective_sample_size: Option<f64>,
    /// The stages in order.
    pub stages: Vec<StageRow>,
}

/// Returns the diagnostics of the sampler; `None` for a fit.
pub fn sampler(calibration: &FinishedCalibration) -> Option<SamplerDiagnostics> {
    let bits = |theta: &[f64]| theta.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    let distinct: BTreeSet<Vec<u64>> = calibration.posterior().iter().map(|s| bits(&s.theta)).collect();
    calibration.estimate().is_none().then(|| SamplerDiagnostics {
        equilibrated: calibration.row.equilibrated,
        draws: calibration.posterior().len(),
        distinct_draws: distinct.len(),
        effective_sample_size: calibration
            .stages()
            .last()
            .map(|stage| stage.ess.min(calibration.posterior().len() as f64)),
        stages: calibration.stages().to_vec(),
    })
}
