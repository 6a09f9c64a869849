//! Point estimates beside a sample, with their names for people.

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

impl Study {
    /// The point estimates beside a sample, with their names for people: `GA optimum`.
    pub(super) fn optima(&self) -> impl Iterator<Item = (String, &FinishedCalibration)> {
        let fitted = self
            .submitted()
            .filter(|calibration| calibration.estimate.is_some());
        fitted.map(|calibration| {
            let name = calibration.spec.algorithm.name().to_uppercase();
            (format!("{name} optimum"), calibration)
        })
    }
}
