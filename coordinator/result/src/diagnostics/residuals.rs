//! Residuals: every fitted measurement compared with its prediction.

use inference::diagnostics::{self, PredictedDraw};

use super::data_channel::run_name;
use crate::finished_calibration::FinishedCalibration;
use crate::words::data_channel::DataChannel;

/// Maximum number of residuals in a list of the largest ones.
const LARGEST: usize = 5;

/// The residual of a fitted measurement from the posterior mean prediction.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ResidualDiagnostics {
    /// Name of the run, or of the plate or ring test.
    pub run: String,
    /// Channel, by its name without unit; `transient_sinkage` for sinkages before the steady state.
    #[schema(value_type = String)]
    pub channel: DataChannel,
    /// Unit of residual and error; for plates and rings they are those of the natural logarithm.
    pub unit: String,
    /// Measured minus predicted.
    pub residual: f64,
    /// Standard deviation of the total error: noise, discrepancy and shared errors.
    pub error_sd: f64,
    /// Leverage: share of the error's variance that the fit absorbs.
    pub leverage: f64,
    /// Studentised residual: the residual over its standard deviation, which is the error's reduced by the leverage; null if the leverage
    /// is 1.
    pub studentised: Option<f64>,
    /// Two-sided probability of a residual at least this large.
    pub p: Option<f64>,
}

/// Returns the residual of each datum in the order of the likelihood; empty for a fit.
pub fn residuals(calibration: &FinishedCalibration, posterior: &[PredictedDraw]) -> Vec<ResidualDiagnostics> {
    let likelihood = &calibration.spec.likelihood;
    // The sampler already evaluated the likelihood of these values, so an error cannot occur here.
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

/// Returns the most improbable residuals, without those that have no probability.
pub fn largest(all: &[ResidualDiagnostics]) -> Vec<&ResidualDiagnostics> {
    let mut judged: Vec<(f64, &ResidualDiagnostics)> = all.iter().filter_map(|r| Some((r.p?, r))).collect();
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    judged.into_iter().map(|(_, r)| r).take(LARGEST).collect()
}
