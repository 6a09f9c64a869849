//! Error table: root mean square errors by channel and over all channels.

use std::collections::BTreeMap;

use shared::channel::Channel;

use super::row::ComparisonRow;

/// Root mean square errors by channel, and over all channels in units of the noise.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ErrorTable {
    /// Drawbar pull.
    pub drawbar_pull: Option<ChannelError>,
    /// Torque.
    pub torque: Option<ChannelError>,
    /// Sinkage.
    pub sinkage: Option<ChannelError>,
    /// Lateral force.
    pub lateral_force: Option<ChannelError>,
    /// All channels together.
    pub all: AllError,
}

/// The error of a channel.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ChannelError {
    /// Root mean square of measured minus predicted [channel's unit].
    pub rmse: f64,
    /// Root mean square in units of each row's noise standard deviation; about 1 for a perfect model.
    pub rmse_sigma: Option<f64>,
    /// Root mean square in units of one noise standard deviation for all calibrations of the study: declared, from repeats, or inferred
    /// by the first calibration.
    pub rmse_fixed_sigma: Option<f64>,
    /// Number of rows.
    pub runs: usize,
}

/// The error over all channels.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct AllError {
    /// Root mean square in units of each row's noise standard deviation.
    pub rmse_sigma: Option<f64>,
    /// Root mean square in units of the study's noise standard deviations.
    pub rmse_fixed_sigma: Option<f64>,
    /// Number of measurements without a prediction, which do not enter: the model refuses the run at half of the final draws or more, or
    /// interpolation or correction is not possible.
    pub unpredicted: usize,
}

impl ErrorTable {
    /// Returns the errors of the posterior-mean prediction; `None` without a prediction.
    pub fn of_model<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<ErrorTable> {
        Self::new(rows.map(|r| (r, r.predicted)))
    }

    /// Returns the errors of interpolation on the rows that the model predicts too; `None` if there is no such row.
    pub fn of_baseline<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<ErrorTable> {
        Self::new(rows.map(|r| (r, r.interpolated.filter(|_| r.predicted.is_some()))))
    }

    /// Returns the errors of the corrected prediction; `None` without one.
    pub fn of_corrected<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<ErrorTable> {
        Self::new(rows.map(|r| (r, r.corrected)))
    }

    /// Returns the errors of the predictions that stand beside the rows; `None` without a prediction.
    pub fn new<'a>(rows: impl Iterator<Item = (&'a ComparisonRow, Option<f64>)>) -> Option<ErrorTable> {
        let mut squares: BTreeMap<Channel, Squares> = BTreeMap::new();
        let mut all = Squares::default();
        let mut unpredicted = 0;
        for (row, predicted) in rows {
            let Some(predicted) = predicted else {
                unpredicted += 1;
                continue;
            };
            let error = row.measured - predicted;
            let sd = row.noise_sd;
            for s in [squares.entry(row.channel).or_default(), &mut all] {
                s.sum += error * error;
                s.rows += 1;
                if let Some(sd) = sd {
                    s.sum_sigma += (error / sd) * (error / sd);
                    s.rows_sigma += 1;
                }
            }
        }
        if all.rows == 0 {
            return None;
        }
        let sigma = |s: &Squares| (s.rows_sigma > 0).then(|| (s.sum_sigma / s.rows_sigma as f64).sqrt());
        let channel = |c: Channel| {
            squares.get(&c).map(|s| ChannelError {
                rmse: (s.sum / s.rows as f64).sqrt(),
                rmse_sigma: sigma(s),
                rmse_fixed_sigma: None,
                runs: s.rows,
            })
        };
        Some(ErrorTable {
            drawbar_pull: channel(Channel::DrawbarPull),
            torque: channel(Channel::Torque),
            sinkage: channel(Channel::Sinkage),
            lateral_force: channel(Channel::LateralForce),
            all: AllError {
                rmse_sigma: sigma(&all),
                rmse_fixed_sigma: None,
                unpredicted,
            },
        })
    }

    /// Returns the error of a channel.
    pub fn channel(&self, channel: Channel) -> Option<ChannelError> {
        match channel {
            Channel::DrawbarPull => self.drawbar_pull,
            Channel::Torque => self.torque,
            Channel::Sinkage => self.sinkage,
            Channel::LateralForce => self.lateral_force,
        }
    }
}

impl ErrorTable {
    /// Returns the error of a channel for modification.
    pub(super) fn channel_mut(&mut self, channel: Channel) -> Option<&mut ChannelError> {
        match channel {
            Channel::DrawbarPull => self.drawbar_pull.as_mut(),
            Channel::Torque => self.torque.as_mut(),
            Channel::Sinkage => self.sinkage.as_mut(),
            Channel::LateralForce => self.lateral_force.as_mut(),
        }
    }
}

/// Sums of squared errors, in SI units and in noise variances, with their numbers of rows.
#[derive(Default, Clone, Copy)]
struct Squares {
    sum: f64,
    sum_sigma: f64,
    rows: usize,
    rows_sigma: usize,
}
