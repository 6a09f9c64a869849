//! Every fitted measurement beside its prediction.

use inference::diagnostics::{self, PredictedDraw};

use super::data_channel::{DataChannel, run_name};
use crate::finished_calibration::FinishedCalibration;

/// Most residuals in a list of the largest.
const LARGEST: usize = 5;

/// A fitted measurement beside the posterior's mean prediction.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ResidualDiagnostics {
    /// Run, or test of plates or rings.
    pub run: String,
    /// Channel without unit.
    pub channel: String,
    /// Unit of the next two; plates and rings count by their natural logarithm.
    pub unit: String,
    /// Measured minus predicted.
    pub residual: f64,
    /// Standard deviation of the error, with what it shares with other data.
    pub error_sd: f64,
    /// Share of the error's variance that the fit takes up.
    pub leverage: f64,
    /// Residual over its own standard deviation, which the leverage makes smaller; null where nothing is left of it.
    pub studentised: Option<f64>,
    /// Two-sided probability of so large a residual.
    pub p: Option<f64>,
}

/// In the order of the likelihood's data; empty of a fit.
pub(crate) fn residuals(
    outcome: &FinishedCalibration,
    posterior: &[PredictedDraw],
) -> Vec<ResidualDiagnostics> {
    let likelihood = &outcome.spec.likelihood;
    // These values were scored while sampling; what cannot be scored never became a final draw.
    let rows = diagnostics::residuals(likelihood, posterior).unwrap_or_default();
    rows.iter()
        .zip(likelihood.data())
        .map(|(row, datum)| {
            let channel = DataChannel::of(datum.channel);
            ResidualDiagnostics {
                run: run_name(&outcome.spec, datum).to_owned(),
                channel: channel.name().to_owned(),
                unit: channel.unit().to_owned(),
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
pub(crate) fn largest(all: &[ResidualDiagnostics]) -> Vec<&ResidualDiagnostics> {
    let mut judged: Vec<(f64, &ResidualDiagnostics)> = all.iter().filter_map(|r| Some((r.p?, r))).collect();
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    judged.into_iter().map(|(_, r)| r).take(LARGEST).collect()
}
