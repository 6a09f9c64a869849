//! Recordings that are followed by the posterior of a calibration.

use shared::api::NewRecording;
use shared::model::ModelVariant;

use super::error::ServiceError;
use super::handle::Service;
use crate::embedded::Evaluate;
use prediction::PredictionError;
use prediction::recording::{CompiledModel, FollowedRecording, RecordingFollower, read_samples};
use result::Study;

/// Largest number of samples of a request: an hour at 10 Hz.
const MAX_SAMPLES: usize = 36_000;

impl Service {
    /// Follows a recording: the parameters of the soil after each second, and its changes.
    ///
    /// # Errors
    /// [`ServiceError`]: the calibration has no posterior, its model is too slow, or the recording is malformed.
    pub async fn stream(&self, id: i64, asked: NewRecording) -> Result<FollowedRecording, ServiceError> {
        self.alone(id, move |study| followed(&study, id, &asked)).await
    }
}

fn followed(study: &Study, id: i64, asked: &NewRecording) -> Result<FollowedRecording, PredictionError> {
    let calibration = study.calibrations().find(|calibration| calibration.row.id == id);
    let calibration = calibration.ok_or(PredictionError::NoDraws(id))?;
    let mut follower = RecordingFollower::new(calibration, &asked.parameters, &compiled)?;
    let defaults = RecordingFollower::defaults(calibration);
    let mut times = Vec::new();
    let samples = read_samples(asked.recording.as_bytes(), asked.wheel.as_ref(), &defaults)?;
    for (number, sample) in samples.enumerate() {
        if number == MAX_SAMPLES {
            let message =
                format!("a recording of a request has at most {MAX_SAMPLES} samples: send it in parts");
            return Err(PredictionError::Request(message));
        }
        times.extend(follower.take(sample?)?);
    }
    Ok(follower.end(times))
}

/// Makes the model of a variant with one condition.
pub(crate) fn compiled(variant: &ModelVariant) -> Result<CompiledModel, String> {
    Ok(Evaluate::new(variant)?.at_one_condition())
}
