//! Equilibrium and effective sample size of the sampler.

use std::collections::BTreeSet;

use record::StageRow;

use crate::finished_calibration::FinishedCalibration;

/// Whether the draws represent the posterior, and how many independent draws they are worth.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct SamplerDiagnostics {
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Draws of the posterior.
    pub draws: usize,
    /// Of these, distinct ones.
    pub distinct_draws: usize,
    /// Effective sample size of the weights at the last stage, before its moves; at most `draws`, which were taken by them.
    pub effective_sample_size: Option<f64>,
    /// The stages, the draws from the prior first.
    pub stages: Vec<StageRow>,
}

/// None of a fit.
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
