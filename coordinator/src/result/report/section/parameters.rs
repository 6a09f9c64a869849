//! Parameters after and before the data: table, densities, and the pairs that the data leave entangled.

use inference::{Distribution, diagnostics};
use maud::{Markup, html};

use crate::result::report::{chart, number};
use crate::result::{Outcome, ParameterSummary};
use crate::spec::FreeParameter;

/// So many pairs are shown.
const PAIRS: usize = 3;

/// Table and pictures.
pub(in crate::result::report) fn parameters(outcome: &Outcome) -> Markup {
    let free = &outcome.spec.parameters;
    let draws: Vec<Vec<f64>> = (0..free.len()).map(|i| outcome.draws(i)).collect();
    let summaries = outcome.parameter_summaries();
    html! {
        @if summaries.is_empty() { p { "There are no draws." } }
        div.scroll { (table(free, &summaries)) }
        p.note {
            "From " (number::count(outcome.posterior.len(), "equally weighted draw")) " of the posterior. Best: the draw with the highest likelihood times prior. "
            "AT BOUND: the 5 % or 95 % quantile lies within 2 % of the prior's range of one of its ends."
        }
        @if !outcome.spec.fit_variant.fixed.is_empty() {
            p.note {
                "Fixed: "
                @for (i, (name, value)) in outcome.spec.fit_variant.fixed.iter().enumerate() {
                    @if i > 0 { ", " }
                    (name) " = " (number::significant(*value, 4))
                }
                "."
            }
        }
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
        (entangled(free, &draws))
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
                        td { (p.prior_mean.map_or(number::NONE.into(), |m| number::to_spread(m, p.prior_sd.unwrap_or(0.0)))) }
                        td { (p.prior_sd.map_or(number::NONE.into(), |s| number::to_spread(s, s))) }
                        td { (p.prior_sd.map_or(number::NONE.into(), |s| number::fixed(p.sd / s, 2))) }
                        td.text { @if p.at_bound { span.alarm { "AT BOUND" } } }
                    }
                }
            }
        }
    }
}

/// `normal, mean 3.93, sd 0.15, between 3 and 5`.
fn prior_words(parameter: &FreeParameter) -> String {
    let n = |x: f64| number::significant(x, 4);
    let (lower, upper) = parameter.marginal.support();
    let (words, own) = match parameter.marginal.distribution() {
        Distribution::Uniform { .. } => ("uniform".into(), false),
        Distribution::Loguniform { .. } => ("uniform in the logarithm".into(), false),
        Distribution::Normal { mean, sd } => (format!("normal, mean {}, sd {}", n(mean), n(sd)), false),
        Distribution::Lognormal { median, factor } => {
            (format!("lognormal, median {}, factor {}", n(median), n(factor)), true)
        }
        Distribution::HalfNormal { scale } => (format!("half-normal, scale {}", n(scale)), true),
    };
    // Zero is where these end by nature.
    let low_is_natural = own && lower.abs() < f64::MIN_POSITIVE;
    match (lower.is_finite() && !low_is_natural, upper.is_finite()) {
        (true, true) => format!("{words}, between {} and {}", trimmed(lower), trimmed(upper)),
        (true, false) => format!("{words}, above {}", trimmed(lower)),
        (false, true) => format!("{words}, below {}", trimmed(upper)),
        (false, false) => words,
    }
}

/// A bound as its author wrote it, as far as that can be known.
fn trimmed(x: f64) -> String {
    if x.abs() < 1e-4 || x.abs() >= 1e6 { number::significant(x, 3) } else { x.to_string() }
}

fn entangled(free: &[FreeParameter], draws: &[Vec<f64>]) -> Markup {
    let pairs = most_correlated(draws);
    html! {
        @if !pairs.is_empty() {
            h3 { "Most correlated pairs" }
            div.charts.small {
                @for (i, j, r) in pairs {
                    @let n = draws[i].len();
                    figure {
                        (chart::pair([&free[i], &free[j]], [&draws[i], &draws[j]]))
                        figcaption { "correlation " b { (number::with_spread(r, correlation_se(r, n))) } }
                    }
                }
            }
            p.note {
                "Each dot is a draw. Where the cloud is a narrow band, the data fix a combination of the two parameters and neither alone. "
                "\u{b1}: standard error of the coefficient for that many independent draws."
            }
        }
    }
}

/// Standard error of a correlation coefficient, kept from vanishing where rounding makes it perfect.
fn correlation_se(r: f64, n: usize) -> f64 {
    ((1.0 - r * r) / (n.max(2) as f64 - 1.0).sqrt()).max(1e-3)
}

/// Positions and Pearson coefficients of the pairs, strongest first; the first of equals.
fn most_correlated(draws: &[Vec<f64>]) -> Vec<(usize, usize, f64)> {
    let mut pairs: Vec<(usize, usize, f64)> = Vec::new();
    for i in 0..draws.len() {
        for j in i + 1..draws.len() {
            pairs.extend(correlation(&draws[i], &draws[j]).map(|r| (i, j, r)));
        }
    }
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    pairs.truncate(PAIRS);
    pairs
}

/// Pearson's coefficient; `None` where a series does not vary.
fn correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    let ((mean_x, _), (mean_y, _)) = (diagnostics::mean_and_sd(x)?, diagnostics::mean_and_sd(y)?);
    let sum = |f: &dyn Fn(f64, f64) -> f64| x.iter().zip(y).map(|(a, b)| f(a - mean_x, b - mean_y)).sum::<f64>();
    let r = sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt();
    r.is_finite().then(|| r.clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use inference::Marginal;

    use super::*;

    #[test]
    fn correlation_of_lines_and_constants() {
        let x = [1.0, 2.0, 3.0];
        assert!((correlation(&x, &[3.0, 2.0, 1.0]).unwrap() + 1.0).abs() < 1e-12);
        assert_eq!(correlation(&x, &[5.0; 3]), None);
    }

    #[test]
    fn strongest_pairs_come_first() {
        let draws = [vec![1.0, 2.0, 3.0, 4.0], vec![1.0, 2.0, 3.0, 4.5], vec![4.0, 1.0, 3.0, 2.0]];
        let pairs = most_correlated(&draws);
        assert_eq!(pairs.len(), 3);
        assert_eq!((pairs[0].0, pairs[0].1), (0, 1));
    }

    #[test]
    fn priors_in_words() {
        let words = |d, bounds| {
            let marginal = Marginal::new(d, bounds).unwrap();
            prior_words(&FreeParameter { name: "n".into(), unit: "1", marginal })
        };
        let normal = Distribution::Normal { mean: 1.1, sd: 0.2 };
        assert_eq!(words(normal, Some([0.8, 2.0])), "normal, mean 1.100, sd 0.2000, between 0.8 and 2");
        let lognormal = Distribution::Lognormal { median: 2.0, factor: 2.8 };
        assert_eq!(words(lognormal, None), "lognormal, median 2.000, factor 2.800");
    }
}
