//! Errors of the model against the readings of plates and rings.

use std::collections::BTreeSet;

use job::{PLATE, RING};

use crate::finished_calibration::FinishedCalibration;
use crate::words::data_channel::BevameterTest;
use crate::words::number;

/// Errors of the model against the readings of plates, or of rings.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadingError {
    /// Kind of test.
    pub test: BevameterTest,
    /// Number of tests.
    pub tests: usize,
    /// Number of readings.
    pub readings: usize,
    /// Root mean square of ln(measured / predicted); the prediction is the posterior mean of the logarithm.
    pub rms_ln: f64,
    /// Root mean square after the mean of each test is subtracted.
    pub rms_ln_within: f64,
}

impl ReadingError {
    /// Returns, for example, `60 readings in 6 tests of plates: ...`.
    pub fn words(&self) -> String {
        format!(
            "{} in {} of {}: root mean square error {:.1} %, {:.1} % within tests",
            number::count(self.readings, "reading"),
            number::count(self.tests, "test"),
            self.test.name(),
            100.0 * self.rms_ln,
            100.0 * self.rms_ln_within
        )
    }
}

/// Returns the errors of plates and of rings, if the experiment has them.
pub fn reading_errors(calibration: &FinishedCalibration) -> Vec<ReadingError> {
    let bevameter = &calibration.spec.bevameter;
    let plates = bevameter.plates.iter().map(|r| &*r.test).collect();
    let rings = bevameter.rings.iter().map(|r| &*r.test).collect();
    [
        (BevameterTest::Plates, PLATE, plates),
        (BevameterTest::Rings, RING, rings),
    ]
    .into_iter()
    .filter_map(|(test, channel, names)| error(calibration, test, channel, names))
    .collect()
}

fn error(
    calibration: &FinishedCalibration,
    test: BevameterTest,
    channel: usize,
    tests: Vec<&str>,
) -> Option<ReadingError> {
    let draws: Vec<Vec<f64>> = calibration
        .predictive_draws()
        .iter()
        .filter_map(|p| Some(calibration.spec.predicted_values(p.fit.as_ref().ok()?)))
        .collect();
    let data = calibration.spec.likelihood.data();
    let residuals: Vec<f64> = (0..data.len())
        .filter(|&i| data[i].channel == channel)
        .map(|i| {
            let mean = draws.iter().map(|values| values[i]).sum::<f64>() / draws.len() as f64;
            data[i].value - mean
        })
        .collect();
    if residuals.is_empty() || draws.is_empty() {
        return None;
    }
    let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let names: BTreeSet<&str> = tests.iter().copied().collect();
    let mut within = Vec::with_capacity(residuals.len());
    for name in &names {
        let of_test: Vec<f64> = (0..tests.len())
            .filter(|&i| tests[i] == *name)
            .map(|i| residuals[i])
            .collect();
        let mean = of_test.iter().sum::<f64>() / of_test.len() as f64;
        within.extend(of_test.iter().map(|r| r - mean));
    }
    Some(ReadingError {
        test,
        tests: names.len(),
        readings: residuals.len(),
        rms_ln: rms(&residuals),
        rms_ln_within: rms(&within),
    })
}
