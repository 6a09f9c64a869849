//! What the sampler did.

use std::collections::BTreeSet;

use record::StageRow;

use crate::finished_calibration::FinishedCalibration;

/// Whether the draws can be read as the posterior, and how many they are worth.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct SamplerDiagnostics {
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Draws of the posterior.
    pub draws: usize,
    /// Of these, different ones.
    pub distinct_draws: usize,
    /// Effective sample size of the weights at the last stage, before its moves.
    pub effective_sample_size: Option<f64>,
    /// The stages, the draws from the prior first.
    pub stages: Vec<StageRow>,
}

/// None of a fit.
pub(crate) fn sampler(outcome: &FinishedCalibration) -> Option<SamplerDiagnostics> {
    let bits = |theta: &[f64]| theta.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    let distinct: BTreeSet<Vec<u64>> = outcome.posterior.iter().map(|s| bits(&s.theta)).collect();
    outcome.estimate.is_none().then(|| SamplerDiagnostics {
        equilibrated: outcome.row.equilibrated,
        draws: outcome.posterior.len(),
        distinct_draws: distinct.len(),
        effective_sample_size: outcome.stages.last().map(|stage| stage.ess),
        stages: outcome.stages.clone(),
    })
}
