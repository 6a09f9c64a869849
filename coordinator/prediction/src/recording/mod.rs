//! A recording that is followed sample by sample: the parameters of the soil in time, and its changes.
//!
//! # Layout
//! - `sample`: rows of a recording. `block`: ten samples, and what they are worth.
//! - `follower`: from samples to parameters. `answer`: what it says.

mod answer;
mod block;
mod follower;
mod sample;

pub use answer::{ChannelNoise, FollowedRecording, RecordedParameter, RecordedTime, SoilChange, WalkSize};
pub use follower::{CompiledModel, RecordingFollower};
pub use sample::{Sample, read_samples};
