//! Parameters, cost and stopping reason of a point estimate.

use inference::point_estimate::StopReason;
use maud::{Markup, html};
use record::EstimateRow;

use super::parameters::{fixed, prior_words};
use super::stages::cost;
use crate::finished_calibration::FinishedCalibration;
use crate::summary::point_estimate::fitted;
use crate::words::number;

/// The most probable parameters.
pub(in crate::report) fn estimate(calibration: &FinishedCalibration, estimate: &EstimateRow) -> Markup {
    html! {
        div.scroll { table {
            thead { tr {
                th.text { "parameter" } th.text { "unit" } th { "most" br; "probable" } th { "sd" } th { "prior" br; "sd" }
                th { "sd over" br; "prior sd" } th.text { "prior" } th.text { "" }
            } }
            tbody {
                @for p in fitted(estimate, &calibration.spec.parameters) {
                    @let prior_sd = p.free.marginal.sd();
                    tr {
                        td.text { (p.free.name) } td.text { (p.free.unit) }
                        td { (number::to_spread(p.value, p.sd.unwrap_or(0.0))) }
                        td { (number::or_none(p.sd, |sd| number::to_spread(sd, sd))) }
                        td { (number::to_spread(prior_sd, prior_sd)) }
                        td { (number::or_none(p.sd, |sd| number::significant(sd / prior_sd, 2))) }
                        td.text { (prior_words(p.free)) }
                        td.text { @if p.at_bound { span.alarm { "AT BOUND" } } }
                    }
                }
            }
        } }
        p.note {
            "Most probable: the highest likelihood times prior density of the parameters as the job declares them. "
            @if estimate.sd.is_some() {
                "Sd: from the curvature there (Laplace), the parameters at a bound held; right where the posterior is a normal distribution, and too small where the noise was inferred from repeats that share a misfit. "
                "AT BOUND: exactly at a bound of the prior; there is no sd."
            } @else {
                "A search by generations does not compute the curvature there, so there are no standard deviations; parameters that the data do not determine may lie anywhere. "
                "AT BOUND: exactly at a bound of the prior."
            }
        }
        (fixed(calibration))
    }
}

/// Cost of the fit and why it stopped.
pub(in crate::report) fn fit(calibration: &FinishedCalibration, estimate: &EstimateRow) -> Markup {
    html! {
        dl {
            dt { "log-posterior" }
            dd {
                (number::significant(estimate.log_posterior(), 5)) " (log-likelihood " (number::significant(estimate.log_likelihood, 5))
                " plus log-density of the prior " (number::significant(estimate.log_prior, 5))
                @if calibration.approximated.is_none() { "; without the evidence, which is unknown" } ")"
            }
            @if calibration.approximated.is_some() {
                dt { "log-evidence" }
                dd { (number::or_none(calibration.row.log_evidence, |z| number::significant(z, 5))) " (natural logarithm; by the normal approximation)" }
                dt { "draws" } dd { (calibration.posterior.len()) " of the normal approximation, in the normal scores of the parameters" }
            }
            dt { "stopped because" } dd { (reason(estimate.stop)) }
            (cost(calibration))
        }
    }
}

/// Why a fit stopped, in words.
pub(super) fn reason(stop: StopReason) -> &'static str {
    match stop {
        StopReason::Decrease => "no step improves the posterior any more",
        StopReason::Step => {
            "no tried step improved the posterior: the numerical noise of the model hides smaller improvements"
        }
        StopReason::Budget => "its budget of evaluations was used; a better point may be near",
        StopReason::Stagnation => "many generations brought no improvement",
        StopReason::Generations => "its last generation was reached; a better point may be near",
    }
}
