//! Point estimates beside a sample, with their names for people.

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

impl Study {
    /// The point estimates beside a sample, with their names for people: `GA optimum`. None of an extended model: they are those of the
    /// submitted one.
    pub(super) fn optima_beside<'a>(
        &'a self,
        sample: &FinishedCalibration,
    ) -> impl Iterator<Item = (String, &'a FinishedCalibration)> {
        let is_submitted = self
            .submitted()
            .any(|submitted| submitted.row.id == sample.row.id);
        let fitted = self
            .submitted()
            .filter(move |calibration| is_submitted && calibration.estimate().is_some());
        fitted.map(|calibration| {
            let name = calibration.spec.algorithm.name().to_uppercase();
            (format!("{name} optimum"), calibration)
        })
    }
}
