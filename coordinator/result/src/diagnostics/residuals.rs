//! Every fitted measurement beside its prediction.

use inference::diagnostics::{self, PredictedDraw};

use super::data_channel::run_name;
use crate::finished_calibration::FinishedCalibration;
use crate::words::data_channel::DataChannel;

/// Most residuals in a list of the largest.
const LARGEST: usize = 5;

/// A fitted measurement beside the posterior's mean prediction.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ResidualDiagnostics {
    /// Run, or test of plates or rings.
    pub run: String,
    /// Channel without unit.
    #[schema(value_type = String)]
    pub channel: DataChannel,
    /// Unit of the next two; plates and rings count by their natural logarithm.
    pub unit: String,
    /// Measured minus predicted.
    pub residual: f64,
    /// Standard deviation of the total error: noise, discrepancy and shared errors.
    pub error_sd: f64,
    /// Share of the error's variance that the fit absorbs.
    pub leverage: f64,
    /// Residual over its own standard deviation, which the leverage makes smaller; null where nothing is left of it.
    pub studentised: Option<f64>,
    /// Two-sided probability of so large a residual.
    pub p: Option<f64>,
}

/// In the order of the likelihood's data; empty of a fit.
pub fn residuals(calibration: &FinishedCalibration, posterior: &[PredictedDraw]) -> Vec<ResidualDiagnostics> {
    let likelihood = &calibration.spec.likelihood;
    // These values were already scored by the sampler; a draw that cannot be scored is no final draw.
    let rows = diagnostics::residuals(likelihood, posterior).unwrap_or_default();
    rows.iter()
        .zip(likelihood.data())
        .map(|(row, datum)| {
            let channel = DataChannel::from_index(datum.channel);
            ResidualDiagnostics {
                run: run_name(&calibration.spec, datum).to_owned(),
                channel,
                unit: channel.si_unit().to_owned(),
                residual: row.value,
                error_sd: row.error_sd,
                leverage: row.leverage,
                studentised: row.studentised,
                p: row.p,
            }
        })
        .collect()
}

/// The most improbable residuals; those that cannot be judged are left out.
pub fn largest(all: &[ResidualDiagnostics]) -> Vec<&ResidualDiagnostics> {
    let mut judged: Vec<(f64, &ResidualDiagnostics)> = all.iter().filter_map(|r| Some((r.p?, r))).collect();
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    judged.into_iter().map(|(_, r)| r).take(LARGEST).collect()
}
