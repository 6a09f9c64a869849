//! The error model in words, with the discrepancy that the data chose.

use super::predictive::discrepancy_posterior;
use crate::finished_calibration::FinishedCalibration;

/// Sentences on the error model, with the posterior of an unknown discrepancy.
pub(crate) fn error_model(calibration: &FinishedCalibration) -> Vec<String> {
    let mut words = calibration.spec.likelihood_settings.words();
    let after = discrepancy_posterior(calibration);
    if !after.is_empty() {
        let levels: Vec<String> = after.iter().map(|(m, p)| format!("{m:.2}: {p:.3}")).collect();
        words.push(format!("posterior probability of each m: {}", levels.join(", ")));
    }
    words.extend(calibration.spec.scatter_words());
    words
}
