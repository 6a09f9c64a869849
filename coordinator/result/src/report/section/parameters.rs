//! Parameters after and before the data: table, densities, and strongly correlated pairs.

use job::FreeParameter;
use maud::{Markup, html};
use statistics::Distribution;

use crate::diagnostics::correlated_pair::{LEAST_CORRELATION, most_correlated};
use crate::finished_calibration::FinishedCalibration;
use crate::report::chart;
use crate::summary::parameter::ParameterSummary;
use crate::words::number;

/// A bound so many standard deviations from the mean needs no mention.
const FAR: f64 = 6.0;

/// Table and pictures.
pub(in crate::report) fn parameters(calibration: &FinishedCalibration) -> Markup {
    let free = &calibration.spec.parameters;
    let draws: Vec<Vec<f64>> = (0..free.len()).map(|i| calibration.draws(i)).collect();
    let summaries = calibration.parameter_summaries();
    html! {
        @if summaries.is_empty() { p { "There are no draws." } }
        div.scroll { (table(free, &summaries)) }
        p.note {
            "From " (number::count(calibration.posterior.len(), "equally weighted draw")) " of the posterior. Best: the draw with the highest likelihood times prior. "
            "AT BOUND: the 5 % or 95 % quantile lies within 2 % of the prior's range of one of its ends."
        }
        (fixed(calibration))
        h3 { "Posterior over prior" }
        div.legend {
            span { svg.swatch viewBox="0 0 22 12" aria-hidden="true" { rect.bar x="1" y="1" width="20" height="10" {} } "posterior" }
            span { svg.swatch viewBox="0 0 22 12" aria-hidden="true" { path.prior d="M1 6h20" {} } "prior density" }
            span { svg.swatch viewBox="0 0 22 12" aria-hidden="true" { path.bound d="M1 6h20" {} } "bound of the prior" }
            span {
                svg.swatch viewBox="0 0 22 12" aria-hidden="true" { path.interval d="M1 6h20" {} circle.median cx="11" cy="6" r="3" {} }
                "median and 90 % interval of the posterior"
            }
        }
        div.charts.small {
            @for ((parameter, values), (_, summary)) in free.iter().zip(&draws).zip(&summaries) {
                figure {
                    (chart::marginal(parameter, values, summary))
                    figcaption { "prior: " (prior_words(parameter)) @if summary.at_bound { " " span.alarm { "AT BOUND" } } }
                }
            }
        }
        (correlated_pairs(free, &draws))
    }
}

/// The parameters that the job fixes.
pub(super) fn fixed(calibration: &FinishedCalibration) -> Markup {
    html! {
        @if !calibration.spec.fit_variant.fixed.is_empty() {
            p.note {
                "Fixed: "
                @for (i, (name, value)) in calibration.spec.fit_variant.fixed.iter().enumerate() {
                    @if i > 0 { ", " }
                    (name) " = " (number::as_written(*value))
                }
                "."
            }
        }
    }
}

fn table(free: &[FreeParameter], summaries: &[(String, ParameterSummary)]) -> Markup {
    html! {
        table {
            thead { tr {
                th.text { "parameter" } th.text { "unit" } th { "mean" } th { "sd" } th { "5 %" } th { "50 %" } th { "95 %" } th { "best" }
                th { "prior" br; "mean" } th { "prior" br; "sd" } th { "sd over" br; "prior sd" } th.text { "" }
            } }
            tbody {
                @for ((name, p), parameter) in summaries.iter().zip(free) {
                    @let value = |x: f64| number::to_spread(x, p.sd);
                    tr {
                        td.text { (name) } td.text { (parameter.unit) } td { (value(p.mean)) } td { (value(p.sd)) }
                        td { (value(p.q05)) } td { (value(p.q50)) } td { (value(p.q95)) } td { (value(p.map)) }
                        td { (number::or_none(p.prior_mean, |m| number::to_spread(m, p.prior_sd.unwrap_or(0.0)))) }
                        td { (number::or_none(p.prior_sd, |s| number::to_spread(s, s))) }
                        td { (number::or_none(p.prior_sd, |s| number::significant(p.sd / s, 2))) }
                        td.text { @if p.at_bound { span.alarm { "AT BOUND" } } }
                    }
                }
            }
        }
    }
}

/// `normal, mean 3.93, sd 0.15, between 3 and 5`.
pub(super) fn prior_words(parameter: &FreeParameter) -> String {
    let n = number::as_written;
    let (lower, upper) = parameter.marginal.support();
    let (words, own) = match parameter.marginal.distribution() {
        Distribution::Uniform { .. } => ("uniform".into(), false),
        Distribution::Loguniform { .. } => ("uniform in the logarithm".into(), false),
        Distribution::Normal { mean, sd } => (format!("normal, mean {}, sd {}", n(mean), n(sd)), false),
        Distribution::Lognormal { median, factor } => (
            format!("lognormal, median {}, factor {}", n(median), n(factor)),
            true,
        ),
        Distribution::HalfNormal { scale } => (format!("half-normal, scale {}", n(scale)), true),
    };
    // Zero is where some end by nature; and a bound without probability near it cuts nothing off.
    let cuts = |bound: f64| {
        let natural = own && bound.abs() < f64::MIN_POSITIVE;
        let far = (bound - parameter.marginal.mean()).abs() > FAR * parameter.marginal.sd();
        bound.is_finite() && !natural && !far
    };
    match (cuts(lower), cuts(upper)) {
        (true, true) => format!("{words}, between {} and {}", n(lower), n(upper)),
        (true, false) => format!("{words}, above {}", n(lower)),
        (false, true) => format!("{words}, below {}", n(upper)),
        (false, false) => words,
    }
}

fn correlated_pairs(free: &[FreeParameter], draws: &[Vec<f64>]) -> Markup {
    let pairs = most_correlated(draws);
    html! {
        @if !pairs.is_empty() {
            h3 { "Most correlated pairs" }
            div.charts.small {
                @for (i, j, r) in pairs {
                    @let n = draws[i].len();
                    figure {
                        (chart::pair([&free[i], &free[j]], [&draws[i], &draws[j]]))
                        figcaption { "rank correlation " b { (number::with_spread(r, correlation_se(r, n))) } }
                    }
                }
            }
            p.note {
                "Each dot is a draw; pairs whose coefficient is below " (LEAST_CORRELATION) " are left out. Where the cloud is a narrow band, the data determine a combination of the two parameters and neither alone. "
                "\u{b1}: standard error of the coefficient for that many independent draws."
            }
        }
    }
}

/// Standard error of a correlation coefficient, kept from vanishing where rounding makes it perfect.
fn correlation_se(r: f64, n: usize) -> f64 {
    ((1.0 - r * r) / (n.max(2) as f64 - 1.0).sqrt()).max(1e-3)
}

#[cfg(test)]
mod tests {
    use statistics::Marginal;

    use super::*;

    #[test]
    fn priors_in_words() {
        let words = |d, bounds| {
            let marginal = Marginal::new(d, bounds).unwrap();
            prior_words(&FreeParameter {
                name: "n".into(),
                unit: "1".into(),
                marginal,
            })
        };
        let normal = Distribution::Normal { mean: 1.1, sd: 0.2 };
        assert_eq!(
            words(normal, Some([0.8, 2.0])),
            "normal, mean 1.1, sd 0.2, between 0.8 and 2"
        );
        let lognormal = Distribution::Lognormal {
            median: 2.0,
            factor: 2.8,
        };
        assert_eq!(words(lognormal, None), "lognormal, median 2, factor 2.8");
        assert_eq!(
            words(normal, Some([-50.0, 2.0])),
            "normal, mean 1.1, sd 0.2, below 2"
        );
    }
}
