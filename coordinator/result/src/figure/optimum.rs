//! Point estimates beside a sample, with their names for people.

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

impl Study {
    /// The point estimates beside a sample, with their names for people: `GA optimum`.
    pub(super) fn optima(&self) -> impl Iterator<Item = (String, &FinishedCalibration)> {
        let fitted = self.outcomes().filter(|outcome| outcome.estimate.is_some());
        fitted.map(|outcome| {
            let name = outcome.spec.method.name().to_uppercase();
            (format!("{name} optimum"), outcome)
        })
    }
}
