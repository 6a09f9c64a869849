//! The point estimates of a study that mark the figures of a sample.

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

impl Study {
    /// Returns the study's point estimates with labels such as `GA optimum`. There are none beside an extended model, because they belong
    /// to the submitted one.
    pub(super) fn optima_beside<'a>(
        &'a self,
        sample: &FinishedCalibration,
    ) -> impl Iterator<Item = (String, &'a FinishedCalibration)> {
        let is_submitted = self.submitted().any(|c| c.row.id == sample.row.id);
        let fitted = self
            .submitted()
            .filter(move |calibration| is_submitted && calibration.estimate().is_some());
        fitted.map(|calibration| {
            let name = calibration.spec.algorithm.name().to_uppercase();
            (format!("{name} optimum"), calibration)
        })
    }
}
