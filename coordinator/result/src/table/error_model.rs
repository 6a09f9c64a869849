//! The error model in words, with the discrepancy that the data chose.

use super::predictive::discrepancy_posterior;
use crate::finished_calibration::FinishedCalibration;

/// Sentences on how the errors of measurements are modelled, with what came of it, for terminal and report.
pub(crate) fn error_model(outcome: &FinishedCalibration) -> Vec<String> {
    let mut words = outcome.spec.likelihood_settings.words();
    let after = discrepancy_posterior(outcome);
    if !after.is_empty() {
        let levels: Vec<String> = after.iter().map(|(m, p)| format!("{m:.2}: {p:.3}")).collect();
        words.push(format!(
            "probability of each m after the data: {}",
            levels.join(", ")
        ));
    }
    words.extend(outcome.spec.scatter_words());
    words
}
