//! `coordinator stream`: follows a recording that comes from standard input.

use std::io::Read;

use prediction::recording::{FollowedRecording, RecordedTime, RecordingFollower, read_samples};
use report::terminal;
use result::FinishedCalibration;
use shared::api::NewRecording;

use super::output::say;
use super::place::Place;
use super::predict::target;
use crate::config::{PredictionFormat, StreamArguments};
use crate::service::recording::compiled;

/// In a folder the samples are followed as they come; a service is sent the whole recording.
pub(super) async fn stream(config: StreamArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.target.source).await?;
    let id = target(&place, config.target.id).await?;
    if config.format == PredictionFormat::Csv {
        say(terminal::RECORDING_TITLES)?;
    }
    let followed = match &place {
        Place::Folder { service, .. } => {
            let calibration = service.finished_calibration(id).await?;
            let format = config.format;
            let work = move || live(&calibration, &config, std::io::stdin());
            let followed = tokio::task::spawn_blocking(work).await??;
            return print_end(&followed, format);
        }
        Place::Service(_) => {
            let asked = NewRecording {
                recording: tokio::task::spawn_blocking(|| std::io::read_to_string(std::io::stdin()))
                    .await??,
                wheel: config.wheel.clone(),
                parameters: config.parameter.clone(),
            };
            let path = format!("/v1/calibrations/{id}/stream");
            place.post::<FollowedRecording>(&path, &asked).await?
        }
    };
    for time in &followed.times {
        print(time, config.format)?;
    }
    print_end(&followed, config.format)
}

/// Follows samples while they come.
fn live(
    calibration: &FinishedCalibration,
    config: &StreamArguments,
    source: impl Read,
) -> anyhow::Result<FollowedRecording> {
    let mut follower = RecordingFollower::new(calibration, &config.parameter, &compiled)?;
    let defaults = RecordingFollower::defaults(calibration);
    for sample in read_samples(source, config.wheel.as_ref(), &defaults)? {
        for time in follower.take(sample?)? {
            print(&time, config.format)?;
        }
    }
    Ok(follower.end(Vec::new()))
}

fn print(time: &RecordedTime, format: PredictionFormat) -> anyhow::Result<()> {
    Ok(say(&match format {
        PredictionFormat::Text => terminal::recorded_time(time),
        PredictionFormat::Json => serde_json::to_string(time)? + "\n",
        PredictionFormat::Csv => terminal::recorded_rows(time),
    })?)
}

fn print_end(followed: &FollowedRecording, format: PredictionFormat) -> anyhow::Result<()> {
    match format {
        PredictionFormat::Text => Ok(say(&terminal::recording_end(followed))?),
        PredictionFormat::Json | PredictionFormat::Csv => Ok(()),
    }
}
