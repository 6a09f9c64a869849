//! The self-contained report.

use super::Outcome;

/// The report as one HTML page.
pub fn page(outcome: &Outcome) -> String {
    format!("<!doctype html><title>{}</title><pre>{}</pre>", outcome.experiment, super::terminal::summary(outcome))
}
