//! The posterior of one parameter over its prior density.

use job::FreeParameter;
use maud::{Markup, html};

use super::axis::{AxisScale, ChartAxis};
use super::frame::{ChartFrame, px};
use super::scale::scale;
use crate::summary::parameter::ParameterSummary;

const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 210.0;
const CURVE_POINTS: usize = 160;
/// How far the picture follows the prior beyond the posterior, in widths of the posterior's 90 % interval.
const REACH: f64 = 2.0;
/// Share of the prior on each side that need not be in the picture.
const TAIL: f64 = 0.01;

/// Histogram of the draws, prior density, bounds, and the 90 % interval with the median.
pub(in crate::report) fn marginal(
    parameter: &FreeParameter,
    draws: &[f64],
    summary: &ParameterSummary,
) -> Markup {
    let x = span(parameter, draws, summary);
    let bars = histogram(draws, x);
    let curve = prior_curve(parameter, x);
    let top = bars
        .iter()
        .map(|b| b.density)
        .chain(curve.iter().map(|p| p.1))
        .fold(0.0, f64::max);
    let frame = ChartFrame::new(
        WIDTH,
        HEIGHT,
        x,
        ChartAxis::new(0.0, 1.15 * top, AxisScale::Linear),
    );
    let [_, _, above, floor] = frame.edges();
    let path: Vec<String> = curve
        .iter()
        .map(|(v, d)| format!("{} {}", px(frame.x.at(*v)), px(frame.y.at(*d))))
        .collect();
    let (lower, upper) = parameter.marginal.support();
    let y = above + 7.0;
    let marks = html! {
        @for bar in bars.iter().filter(|b| b.density > 0.0) {
            @let (left, right, top) = (frame.x.at(bar.low), frame.x.at(bar.high), frame.y.at(bar.density));
            rect.bar x=(px(left)) y=(px(top)) width=(px(right - left)) height=(px(floor - top)) {}
        }
        path.prior d={ "M" (path.join("L")) } {}
        @for bound in [lower, upper].into_iter().filter(|b| frame.x.holds(*b)) {
            path.bound d={ "M" (px(frame.x.at(bound))) " " (px(floor)) "V" (px(above)) } {}
        }
        path.interval d={ "M" (px(frame.x.at(summary.q05))) " " (px(y)) "H" (px(frame.x.at(summary.q95))) } {}
        circle.median cx=(px(frame.x.at(summary.q50))) cy=(px(y)) r="3" {}
    };
    let label = format!("posterior and prior of {}", parameter.name);
    let density = if x.is_log() {
        "density of the logarithm"
    } else {
        "density"
    };
    // The area is one, so the height says nothing that the width does not.
    frame.draw(
        &label,
        &format!("{} [{}]", parameter.name, parameter.unit),
        density,
        [4, 0],
        &marks,
    )
}

/// The range worth seeing: every draw, and the prior as far as it lies near.
fn span(parameter: &FreeParameter, draws: &[f64], summary: &ParameterSummary) -> ChartAxis {
    let prior = &parameter.marginal;
    let scale = scale(parameter, draws);
    let log = scale == AxisScale::Log;
    let forward = |x: f64| if log { x.ln() } else { x };
    let backward = |u: f64| if log { u.exp() } else { u };
    let reach = REACH * (forward(summary.q95) - forward(summary.q05));
    let low = backward(forward(prior.quantile(TAIL)).max(forward(summary.q05) - reach));
    let high = backward(forward(prior.quantile(1.0 - TAIL)).min(forward(summary.q95) + reach));
    // The ends of a flat prior belong in the picture where they are near.
    let (lower, upper) = prior.support();
    let near =
        |bound: f64, end: f64| (forward(bound) - forward(end)).abs() < 0.25 * (forward(high) - forward(low));
    let bounds = [(lower, low), (upper, high)]
        .into_iter()
        .filter(|(b, e)| b.is_finite() && near(*b, *e));
    let values = draws
        .iter()
        .copied()
        .chain([low, high])
        .chain(bounds.map(|b| b.0));
    ChartAxis::around(values, 0.03, scale)
}

/// A bar of the histogram.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bar {
    low: f64,
    high: f64,
    density: f64,
}

/// Bars of equal width on the axis over the range of the draws; their density is that of the axis' coordinate.
fn histogram(draws: &[f64], x: ChartAxis) -> Vec<Bar> {
    let unit = x.on(0.0, 1.0);
    let mut shares: Vec<f64> = draws.iter().map(|v| unit.at(*v)).collect();
    shares.sort_by(f64::total_cmp);
    let (Some(&first), Some(&last)) = (shares.first(), shares.last()) else {
        return Vec::new();
    };
    let quartile = |p: f64| inference::diagnostics::quantile(&shares, p).unwrap_or(first);
    // Freedman & Diaconis 1981: 2 IQR / n^(1/3).
    let wanted = 2.0 * (quartile(0.75) - quartile(0.25)) / (shares.len() as f64).cbrt();
    let range = (last - first).max(1e-6);
    let bins = if wanted > 0.0 {
        (range / wanted).ceil().clamp(5.0, 40.0)
    } else {
        5.0
    };
    let width = range / bins;
    let mut counts = vec![0usize; bins as usize];
    for share in &shares {
        let bin = (((share - first) / width) as usize).min(counts.len() - 1);
        counts[bin] += 1;
    }
    let per_share = axis_length(x);
    let bar = |(k, count): (usize, &usize)| Bar {
        low: x.value(first + k as f64 * width),
        high: x.value(first + (k + 1) as f64 * width),
        density: *count as f64 / (shares.len() as f64 * width * per_share),
    };
    counts.iter().enumerate().map(bar).collect()
}

/// The prior's density of the axis' coordinate, with the foot of each jump at a bound.
fn prior_curve(parameter: &FreeParameter, x: ChartAxis) -> Vec<(f64, f64)> {
    let prior = &parameter.marginal;
    let (lower, upper) = prior.support();
    let density = |v: f64| {
        let log = prior.log_density(v) + if x.is_log() { v.ln() } else { 0.0 };
        let density = log.exp();
        if density.is_finite() { density } else { 0.0 }
    };
    let (from, to) = (x.low.max(lower), x.high.min(upper));
    let inner = ChartAxis::new(
        from,
        to,
        if x.is_log() {
            AxisScale::Log
        } else {
            AxisScale::Linear
        },
    );
    let mut points = Vec::new();
    if x.holds(lower) {
        points.push((from, 0.0));
    }
    points.extend((0..=CURVE_POINTS).map(|k| {
        let v = inner.value(k as f64 / CURVE_POINTS as f64).max(from).min(to);
        (v, density(v))
    }));
    if x.holds(upper) {
        points.push((to, 0.0));
    }
    points
}

/// Length of the axis in its coordinate.
fn axis_length(x: ChartAxis) -> f64 {
    if x.is_log() {
        (x.high / x.low).ln()
    } else {
        x.high - x.low
    }
}

#[cfg(test)]
mod tests {
    use statistics::{Distribution, Marginal};

    use super::*;

    fn parameter(distribution: Distribution, bounds: Option<[f64; 2]>) -> FreeParameter {
        FreeParameter {
            name: "n".into(),
            unit: "1".into(),
            marginal: Marginal::new(distribution, bounds).unwrap(),
        }
    }

    fn area(points: &[(f64, f64)], log: bool) -> f64 {
        let u = |x: f64| if log { x.ln() } else { x };
        points
            .windows(2)
            .map(|w| 0.5 * (w[0].1 + w[1].1) * (u(w[1].0) - u(w[0].0)))
            .sum()
    }

    #[test]
    fn the_prior_s_curve_encloses_one() {
        let normal = parameter(Distribution::Normal { mean: 1.3, sd: 0.2 }, Some([0.8, 2.0]));
        let flat = parameter(
            Distribution::Uniform {
                lower: 0.0,
                upper: 4.0,
            },
            None,
        );
        let lognormal = parameter(
            Distribution::Lognormal {
                median: 2.0,
                factor: 2.8,
            },
            None,
        );
        for (parameter, axis) in [
            (&normal, ChartAxis::new(0.0, 3.0, AxisScale::Linear)),
            (&flat, ChartAxis::new(-1.0, 5.0, AxisScale::Linear)),
            (&lognormal, ChartAxis::new(0.01, 400.0, AxisScale::Log)),
        ] {
            let curve = prior_curve(parameter, axis);
            assert!(
                (area(&curve, axis.is_log()) - 1.0).abs() < 0.01,
                "{:?}",
                parameter.marginal.distribution()
            );
        }
    }

    #[test]
    fn the_histogram_encloses_one() {
        let draws: Vec<f64> = (0..500).map(|k| f64::from(k * k % 337)).collect();
        let axis = ChartAxis::new(-50.0, 400.0, AxisScale::Linear);
        let sum: f64 = histogram(&draws, axis)
            .iter()
            .map(|b| b.density * (b.high - b.low))
            .sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn equal_draws_still_make_a_bar() {
        let bars = histogram(&[2.0; 10], ChartAxis::new(1.0, 3.0, AxisScale::Linear));
        assert!(bars.iter().all(|b| b.density.is_finite()) && bars.iter().any(|b| b.density > 0.0));
    }
}
