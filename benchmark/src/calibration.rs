//! A calibration on the thread of the caller.

use std::sync::Arc;

use coordinator::embedded::Evaluate;
use farm::calibration::{Calibration, CalibrationIdentity, SimulationResult};
use job::Spec;

use super::error::StudyError;

/// Runs the calibration of a job to its end.
pub fn calibrate(spec: Spec) -> Result<Calibration, StudyError> {
    let model = Evaluate::new(&spec.fit_variant)?;
    let identity = CalibrationIdentity {
        id: 0,
        name: "benchmark".into(),
        study: 0,
        experiment: 0,
    };
    let mut calibration = Calibration::new(identity, Arc::new(spec))?;
    while calibration.engine().finding().is_none() {
        if let Some(message) = &calibration.message {
            return Err(message.clone().into());
        }
        for evaluation in calibration.queue.asked() {
            let Some(question) = calibration.question(evaluation) else {
                break;
            };
            let computed = SimulationResult::new(model.evaluate(question.theta))?;
            calibration.complete(evaluation, computed, "benchmark")?;
            calibration.step();
        }
    }
    Ok(calibration)
}
