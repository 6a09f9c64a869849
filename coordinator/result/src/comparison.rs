//! Model against measurement, run by run.

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::FinishedCalibration;
use super::baseline::Baseline;
use super::errors::ErrorTable;
use super::group::{ErrorGroup, error_groups};
use super::predictive::{Levels, predictive};

/// Model against measurement.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Comparison {
    /// One row for each run and measured channel.
    pub rows: Vec<ComparisonRow>,
    /// Errors of the fitted runs.
    pub fit: Option<ErrorTable>,
    /// Errors of the runs that were not fitted.
    pub holdout: Option<ErrorTable>,
    /// Errors of interpolating the fitted measurements in slip, without physics, on the holdout runs.
    pub baseline_holdout: Option<ErrorTable>,
    /// Errors by level of slip, load and speed, and by wheel, of fitted runs and of the others.
    pub groups: Vec<ErrorGroup>,
}

/// A run and channel.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ComparisonRow {
    /// Name of the run.
    pub run: String,
    /// `fit` or `holdout`.
    #[serde(rename = "use")]
    pub usage: String,
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
    pub channel: String,
    /// Unit of the next figures.
    pub unit: String,
    /// Measured.
    pub measured: f64,
    /// Posterior mean of the model, or its value at the point that a fit found; `None` where every draw was refused.
    pub predicted: Option<f64>,
    /// 5 % quantile of a new measurement; `None` of a fit, which has no distribution.
    pub q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub q95: Option<f64>,
    /// Noise standard deviation: declared, its posterior mean, or fitted.
    pub noise_sd: Option<f64>,
    /// (measured - predicted) / noise sd.
    pub residual_sigma: Option<f64>,
    /// Interpolation of the fitted measurements in slip; `None` inside the fit and where it would extrapolate.
    pub interpolated: Option<f64>,
}

impl ComparisonRow {
    /// Whether the measurement lies in its 90 % interval.
    pub fn covered(&self) -> Option<bool> {
        Some((self.q05?..=self.q95?).contains(&self.measured))
    }
}

impl FinishedCalibration {
    /// Model against measurement, run by run.
    pub fn comparison(&self) -> Comparison {
        let baseline = Baseline::new(&self.spec.experiment);
        let levels = Levels::of(self);
        let mut rows = Vec::new();
        for (i, run) in self.spec.experiment.runs.iter().enumerate() {
            for channel in Channel::ALL {
                let Some(measured) = run.measured[channel.index()] else {
                    continue;
                };
                let p = predictive(self, &levels, i, channel);
                let holdout = run.usage == RunUse::Holdout;
                rows.push(ComparisonRow {
                    run: run.name.clone(),
                    usage: run.usage.name().into(),
                    wheel: run.wheel.clone(),
                    slip: run.slip,
                    wheel_load_n: run.wheel_load_n,
                    sled_speed_m_s: run.sled_speed_m_s,
                    slip_angle_deg: run.slip_angle_deg,
                    channel: channel.name().into(),
                    unit: channel.unit().into(),
                    measured,
                    predicted: p.map(|p| p.mean),
                    q05: p.and_then(|p| p.interval).map(|[q05, _]| q05),
                    q95: p.and_then(|p| p.interval).map(|[_, q95]| q95),
                    noise_sd: p.and_then(|p| p.noise_sd),
                    residual_sigma: p.and_then(|p| p.noise_sd.map(|sd| (measured - p.mean) / sd)),
                    interpolated: if holdout {
                        baseline.interpolate(run, channel)
                    } else {
                        None
                    },
                });
            }
        }
        let errors = |usage: &str| ErrorTable::of_model(rows.iter().filter(|r| r.usage == usage));
        Comparison {
            fit: errors("fit"),
            holdout: errors("holdout"),
            baseline_holdout: ErrorTable::of_baseline(rows.iter().filter(|r| r.usage == "holdout")),
            groups: error_groups(&rows),
            rows,
        }
    }
}
