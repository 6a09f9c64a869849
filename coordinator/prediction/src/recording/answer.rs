//! The answer about a recording: parameters in time, and changes of the soil.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A recording that was followed to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FollowedRecording {
    /// Id of the calibration.
    pub calibration: i64,
    /// The parameters after each second.
    pub times: Vec<RecordedTime>,
    /// Changes of the soil.
    pub changes: Vec<SoilChange>,
    /// Probability of each size of the walk at the end.
    pub walk: Vec<WalkSize>,
    /// Noise of a sample by channel, at the end; empty of a recording that is too short to know it.
    pub noise: Vec<ChannelNoise>,
}

/// The parameters after ten samples: a second at 10 Hz.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RecordedTime {
    /// Time of the last sample `[s]`.
    pub t_s: f64,
    /// The parameters that may vary.
    pub parameters: Vec<RecordedParameter>,
    /// Probability that the soil has changed since the last change that was flagged.
    pub change_probability: f64,
    /// A change that is flagged at this time.
    pub change: Option<SoilChange>,
    /// Whether the model refuses the samples at all probable parameters, so that they say nothing.
    pub is_refused: bool,
}

/// A parameter at a time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RecordedParameter {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Posterior median, given the samples so far.
    pub median: f64,
    /// 90 % interval.
    pub interval: [f64; 2],
}

/// A change of the soil.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SoilChange {
    /// Most probable time of the change, to a second `[s]`. A change at the first sample says that the recording does not begin in the soil
    /// of the calibration.
    pub t_s: f64,
    /// Time at which it was flagged `[s]`.
    pub found_s: f64,
    /// Probability of a change when it was flagged.
    pub probability: f64,
}

/// A size of the walk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct WalkSize {
    /// Standard deviation of the walk in a second, over that of the prior, in normal scores.
    pub prior_sds: f64,
    /// Its probability.
    pub probability: f64,
}

/// The noise of the samples of a channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ChannelNoise {
    /// Channel, as a column of the recording.
    pub channel: String,
    /// Standard deviation of a sample, in the channel's unit.
    pub sd: f64,
    /// Number of samples that are worth one independent sample.
    pub correlated_samples: f64,
}
