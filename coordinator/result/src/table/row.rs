//! A measured channel of a run beside its prediction.

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::corrected::Corrected;
use super::interpolation::InterpolatedOver;
use super::refusal::Refusal;

/// A run and channel.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ComparisonRow {
    /// Name of the run.
    pub run: String,
    /// `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Wheel.
    pub wheel: String,
    /// Slip.
    pub slip: f64,
    /// Wheel load `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed `[m/s]`.
    pub sled_speed_m_s: f64,
    /// Slip angle `[deg]`.
    pub slip_angle_deg: f64,
    /// Channel without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Unit of the next figures.
    pub unit: String,
    /// Measured.
    pub measured: f64,
    /// Posterior mean of the model, or its value at the point that a fit found; `None` where every draw was rejected, of a held-out run
    /// half of them.
    pub predicted: Option<f64>,
    /// 5 % quantile of a new measurement; `None` of a fit, which has no distribution.
    pub q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub q95: Option<f64>,
    /// Noise standard deviation: declared, its posterior mean, or fitted.
    pub noise_sd: Option<f64>,
    /// (measured - predicted) / noise sd.
    pub residual_sigma: Option<f64>,
    /// Standard deviation of all errors that the calibration assumes or infers: noise, scatter of the soil and discrepancy (of Student's
    /// t the scale); what the diagnosis judges residuals by. Null where no noise is known.
    pub error_sd: Option<f64>,
    /// The prediction with the discrepancy of the model that the fitted conditions show, of a fitted run the other conditions; `None`
    /// where they show none.
    pub corrected: Option<f64>,
    /// 5 % quantile of a new measurement by the corrected prediction; `None` of a fit, which has no distribution.
    pub corrected_q05: Option<f64>,
    /// 95 % quantile.
    pub corrected_q95: Option<f64>,
    /// The final draws at which the model refuses the run; `None` where it refuses none.
    pub refused: Option<Refusal>,
    /// Interpolation of the fitted measurements, without physics; `None` inside the fit, and where there is none.
    pub interpolated: Option<f64>,
    /// What it interpolates over.
    #[schema(value_type = Option<String>)]
    pub interpolated_over: Option<InterpolatedOver>,
}

impl ComparisonRow {
    /// Whether the measurement lies in its 90 % interval.
    pub fn covered(&self) -> Option<bool> {
        Some((self.q05?..=self.q95?).contains(&self.measured))
    }

    /// The corrected prediction.
    pub fn corrected_prediction(&self) -> Option<Corrected> {
        Some(Corrected {
            mean: self.corrected?,
            interval: self
                .corrected_q05
                .zip(self.corrected_q95)
                .map(|(q05, q95)| [q05, q95]),
        })
    }

    /// Whether the measurement lies in the 90 % interval of the corrected prediction.
    pub fn covered_corrected(&self) -> Option<bool> {
        Some((self.corrected_q05?..=self.corrected_q95?).contains(&self.measured))
    }

    /// Whether the model and interpolation both predict it, so that their errors compare; interpolation without extrapolating.
    pub fn is_interpolated(&self) -> bool {
        let is_within = self
            .interpolated_over
            .is_some_and(|over| over != InterpolatedOver::Extrapolation);
        self.predicted.is_some() && is_within
    }
}

/// The rows of the fitted runs, or of the holdout runs.
pub fn rows_of(rows: &[ComparisonRow], usage: RunUse) -> impl Iterator<Item = &ComparisonRow> + Clone {
    rows.iter().filter(move |row| row.usage == usage)
}
