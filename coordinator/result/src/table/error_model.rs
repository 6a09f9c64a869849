//! Sentences on the error model of a calibration, with the posterior of an unknown discrepancy.

use super::predictive::discrepancy_posterior;
use crate::finished_calibration::FinishedCalibration;

/// Posterior probability below which a value of m is not listed.
const MIN_SHOWN: f64 = 0.0005;

/// Returns sentences on the error model, with the posterior of an unknown discrepancy.
pub fn error_model(calibration: &FinishedCalibration) -> Vec<String> {
    let mut words = calibration.spec.likelihood_settings.words();
    for (channel, after) in discrepancy_posterior(calibration) {
        let probable = after.iter().filter(|(_, p)| *p >= MIN_SHOWN);
        let levels: Vec<String> = probable.map(|(m, p)| format!("{m:.2}: {p:.3}")).collect();
        words.push(format!(
            "posterior probability of each m of {}: {}",
            channel.words(),
            levels.join(", ")
        ));
    }
    words.extend(calibration.spec.scatter_words());
    words
}
