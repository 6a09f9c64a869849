//! The point estimates of a study, with the same comparison tables as a sample.

use maud::{Markup, html};

use super::comparison::comparison;
use super::errors::errors;
use super::estimate::{estimate, fit};
use crate::finished_calibration::FinishedCalibration;

/// Each in the order of the job: its parameters, its cost, and model against measurement.
pub(in crate::report) fn point_estimates(calibrations: &[FinishedCalibration]) -> Markup {
    html! {
        p {
            "The same job, fitted instead of sampled. A point estimate does not show which other parameters the data allow; "
            "where it lies far from the bulk of the posterior, the data do not determine the parameters that differ."
        }
        @for calibration in calibrations {
            @if let Some(found) = &calibration.estimate {
                @let compared = calibration.comparison();
                h3 { (calibration.spec.algorithm.words()) }
                (estimate(calibration, found))
                (fit(calibration, found))
                (errors(calibration, &compared))
                details { summary { "Model against measurement at this point" } (comparison(calibration, &compared)) }
            }
        }
    }
}
