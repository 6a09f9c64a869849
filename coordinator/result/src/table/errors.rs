//! Root mean square errors by channel.

use std::collections::BTreeMap;

use shared::channel::Channel;

use super::row::ComparisonRow;

/// Errors by channel, and over all channels in units of the noise.
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
    /// Every channel together.
    pub all: AllError,
}

/// The error of a channel.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ChannelError {
    /// Root mean square of measured minus predicted [channel's unit].
    pub rmse: f64,
    /// The same in units of each row's noise sd; a perfect model scores about 1.
    pub rmse_sigma: Option<f64>,
    /// The same in units of one noise sd, equal for all calibrations of the study: declared, from repeats, or inferred by the first.
    pub rmse_fixed_sigma: Option<f64>,
    /// Rows that count.
    pub runs: usize,
}

/// The error over all channels.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct AllError {
    /// Root mean square in units of each row's noise sd.
    pub rmse_sigma: Option<f64>,
    /// The same in units of the study's noise sds.
    pub rmse_fixed_sigma: Option<f64>,
    /// Measurements without a prediction, which do not count: of runs that the model refuses at half of the final draws or more, or that
    /// interpolation, or a correction, does not reach.
    pub unpredicted: usize,
}

impl ErrorTable {
    /// Errors of the posterior-mean prediction; `None` without rows.
    pub fn of_model<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<ErrorTable> {
        Self::new(rows.map(|r| (r, r.predicted)))
    }

    /// Errors of interpolation without physics where the model has a prediction too; `None` where there is no such row.
    pub fn of_baseline<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<ErrorTable> {
        Self::new(rows.map(|r| (r, r.interpolated.filter(|_| r.predicted.is_some()))))
    }

    /// Errors of the corrected prediction; `None` where there is none.
    pub fn of_corrected<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<ErrorTable> {
        Self::new(rows.map(|r| (r, r.corrected)))
    }

    /// Errors of any predictions; `None` where there is none.
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

    /// The error of a channel.
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
    /// The error of a channel, to change.
    pub(super) fn channel_mut(&mut self, channel: Channel) -> Option<&mut ChannelError> {
        match channel {
            Channel::DrawbarPull => self.drawbar_pull.as_mut(),
            Channel::Torque => self.torque.as_mut(),
            Channel::Sinkage => self.sinkage.as_mut(),
            Channel::LateralForce => self.lateral_force.as_mut(),
        }
    }
}

/// Squares by channel: (sum, sum in sigma^2, rows, rows with a noise sd).
#[derive(Default, Clone, Copy)]
struct Squares {
    sum: f64,
    sum_sigma: f64,
    rows: usize,
    rows_sigma: usize,
}
