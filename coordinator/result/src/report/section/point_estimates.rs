//! The point estimates beside a sample: each a calibration with the same comparison tables.

use maud::{Markup, html};

use super::comparison::comparison;
use super::errors::errors;
use super::estimate::{estimate, fit};
use crate::finished_calibration::FinishedCalibration;

/// Each in the order of the job: what it found, what that cost, and model against measurement there.
pub(in crate::report) fn point_estimates(outcomes: &[FinishedCalibration]) -> Markup {
    html! {
        p {
            "The same job, fitted instead of sampled. A point estimate says nothing of what else the data allow; "
            "where it lies far from the posterior's bulk, the data do not fix what differs."
        }
        @for outcome in outcomes {
            @if let Some(found) = &outcome.estimate {
                @let compared = outcome.comparison();
                h3 { (outcome.spec.method.words()) }
                (estimate(outcome, found))
                (fit(outcome, found))
                (errors(outcome, &compared))
                details { summary { "Model against measurement at this point" } (comparison(outcome, &compared)) }
            }
        }
    }
}
