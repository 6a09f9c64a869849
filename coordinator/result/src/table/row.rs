//! A row of a comparison: a measured channel of a run with its predictions.

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::corrected::Corrected;
use super::holdout_group::HoldoutGroup;
use super::interpolation::InterpolatedOver;
use super::refusal::Refusal;

/// The measurement of a run and channel with its predictions.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ComparisonRow {
    /// Name of the run.
    pub run: String,
    /// Use of the run: `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Place of a holdout run among the fitted conditions: `in_levels`, `between_levels` or `beyond`; null for a fitted run.
    #[serde(default)]
    #[schema(value_type = Option<String>)]
    pub holdout_group: Option<HoldoutGroup>,
    /// Name of the wheel.
    pub wheel: String,
    /// Slip of the run.
    pub slip: f64,
    /// Wheel load `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed `[m/s]`.
    pub sled_speed_m_s: f64,
    /// Slip angle `[deg]`.
    pub slip_angle_deg: f64,
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Unit of the following values.
    pub unit: String,
    /// Measured value.
    pub measured: f64,
    /// Posterior mean of the model, or its value at the point of a fit; `None` if every draw was rejected, or half of them for a holdout
    /// run.
    pub predicted: Option<f64>,
    /// 5 % quantile of a new measurement; `None` for a fit, which has no distribution.
    pub q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub q95: Option<f64>,
    /// Noise standard deviation: declared, its posterior mean, or fitted.
    pub noise_sd: Option<f64>,
    /// (measured - predicted) / noise sd.
    pub residual_sigma: Option<f64>,
    /// Standard deviation of the total error that the calibration assumes or infers: noise, scatter of the soil and discrepancy (for
    /// Student's t the scale). The diagnostics judge residuals by it. Null if the noise is unknown.
    pub error_sd: Option<f64>,
    /// The prediction plus the discrepancy, which is estimated from the fitted conditions, for a fitted run from the other conditions;
    /// `None` if it cannot be estimated.
    pub corrected: Option<f64>,
    /// 5 % quantile of a new measurement by the corrected prediction; `None` for a fit, which has no distribution.
    pub corrected_q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub corrected_q95: Option<f64>,
    /// The final draws at which the model refuses the run; `None` if it refuses none.
    pub refused: Option<Refusal>,
    /// Interpolation of the fitted measurements without physics; `None` for a fitted run, and if interpolation is not possible.
    pub interpolated: Option<f64>,
    /// Conditions of the interpolation.
    #[schema(value_type = Option<String>)]
    pub interpolated_over: Option<InterpolatedOver>,
}

impl ComparisonRow {
    /// Returns whether the 90 % interval contains the measurement; `None` without an interval.
    pub fn covered(&self) -> Option<bool> {
        Some((self.q05?..=self.q95?).contains(&self.measured))
    }

    /// Returns the corrected prediction; `None` without one.
    pub fn corrected_prediction(&self) -> Option<Corrected> {
        Some(Corrected {
            mean: self.corrected?,
            interval: self
                .corrected_q05
                .zip(self.corrected_q95)
                .map(|(q05, q95)| [q05, q95]),
        })
    }

    /// Returns whether the 90 % interval of the corrected prediction contains the measurement; `None` without an interval.
    pub fn covered_corrected(&self) -> Option<bool> {
        Some((self.corrected_q05?..=self.corrected_q95?).contains(&self.measured))
    }

    /// Returns whether both the model and interpolation (without extrapolation) predict the row, so that their errors compare.
    pub fn is_interpolated(&self) -> bool {
        let is_within = self
            .interpolated_over
            .is_some_and(|over| over != InterpolatedOver::Extrapolation);
        self.predicted.is_some() && is_within
    }
}

/// Returns the fitted rows or the holdout rows.
pub fn rows_of(rows: &[ComparisonRow], usage: RunUse) -> impl Iterator<Item = &ComparisonRow> + Clone {
    rows.iter().filter(move |row| row.usage == usage)
}
