//! Figure of the posterior and prior density of each parameter.

use inference::diagnostics;
use job::FreeParameter;

use super::axis_parameter::AxisParameter;
use super::log_axis::is_logarithmic;
use super::reference;
use super::thinned::{five_digits, thinned_draws};
use crate::finished_calibration::FinishedCalibration;
use crate::parameter_summary::ParameterSummary;

/// Number of grid points.
const GRID: usize = 96;
/// Maximum extent of the grid beyond the posterior's 90 % interval, in widths of that interval.
const REACH: f64 = 2.0;
/// Tail probability of the prior on each side that the grid may omit.
const TAIL: f64 = 0.01;

/// Posterior and prior of a parameter.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct MarginalDensity {
    /// Name and unit of the parameter.
    pub parameter: AxisParameter,
    /// Whether the grid is logarithmic; the densities are then those of the natural logarithm.
    pub logarithmic: bool,
    /// Values at which the densities are given.
    pub grid: Vec<f64>,
    /// Density of the prior, in 1 over the parameter's unit.
    pub prior: Vec<f64>,
    /// Density of the posterior, by a Gaussian kernel reflected at the bounds of the prior; empty if all draws are equal.
    pub posterior: Vec<f64>,
    /// Bounds of the prior's support; null if infinite.
    pub bounds: [Option<f64>; 2],
    /// Value of the most probable parameter vector.
    pub mode: f64,
    /// Value from an independent test, stated in the job or estimated from plates and rings; null without one.
    pub reference: Option<f64>,
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
    /// 5 % quantile.
    pub q05: f64,
    /// Median.
    pub q50: f64,
    /// 95 % quantile.
    pub q95: f64,
}

/// Returns the densities of each parameter, in the order of the job.
pub(super) fn all(sample: &FinishedCalibration) -> Vec<MarginalDensity> {
    let reference = reference::values(&sample.spec);
    let summaries = sample.parameter_summaries();
    let parameters = sample
        .spec
        .parameters
        .iter()
        .zip(thinned_draws(sample))
        .zip(summaries);
    let marginal = |((parameter, draws), (name, summary)): ((&FreeParameter, Vec<f64>), (String, _))| {
        density(parameter, &draws, &summary, reference.get(&name).copied())
    };
    parameters.map(marginal).collect()
}

fn density(
    parameter: &FreeParameter,
    draws: &[f64],
    summary: &ParameterSummary,
    reference: Option<f64>,
) -> MarginalDensity {
    let prior = &parameter.marginal;
    let (lower, upper) = prior.support();
    let min = draws.iter().copied().fold(f64::INFINITY, f64::min);
    let max = draws.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let logarithmic = is_logarithmic(prior, draws);
    let forward = |x: f64| if logarithmic { libm::log(x) } else { x };
    let backward = |u: f64| if logarithmic { libm::exp(u) } else { u };
    let reach = REACH * (forward(summary.q95) - forward(summary.q05));
    let low = forward(prior.quantile(TAIL))
        .max(forward(summary.q05) - reach)
        .min(forward(min));
    let high = forward(prior.quantile(1.0 - TAIL))
        .min(forward(summary.q95) + reach)
        .max(forward(max));
    let step = (high - low) / (GRID - 1) as f64;
    let coordinates: Vec<f64> = (0..GRID).map(|k| low + step * k as f64).collect();
    let before = |&u: &f64| {
        let jacobian = if logarithmic { u } else { 0.0 };
        let density = libm::exp(prior.log_density(backward(u).clamp(lower, upper)) + jacobian);
        if density.is_finite() {
            five_digits(density)
        } else {
            0.0
        }
    };
    let values: Vec<f64> = draws.iter().map(|x| forward(*x)).collect();
    let support = match logarithmic {
        true => (libm::log(lower.max(0.0)), libm::log(upper)),
        false => (lower, upper),
    };
    let after = diagnostics::density(&values, support, &coordinates).unwrap_or_default();
    MarginalDensity {
        parameter: parameter.into(),
        logarithmic,
        prior: coordinates.iter().map(before).collect(),
        posterior: after.into_iter().map(five_digits).collect(),
        grid: coordinates.into_iter().map(backward).collect(),
        bounds: [lower, upper].map(|bound| bound.is_finite().then_some(bound)),
        mode: summary.map,
        reference,
        mean: summary.mean,
        sd: five_digits(summary.sd),
        q05: summary.q05,
        q50: summary.q50,
        q95: summary.q95,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn both_densities_hold_what_lies_on_the_grid() {
        for marginal in all(&fixture::calibration()) {
            let on_axis = |x: f64| if marginal.logarithmic { x.ln() } else { x };
            let area = |density: &[f64]| -> f64 {
                let places = marginal.grid.windows(2).zip(density.windows(2));
                let areas = places.map(|(x, f)| 0.5 * (f[0] + f[1]) * (on_axis(x[1]) - on_axis(x[0])));
                areas.sum()
            };
            let (before, after) = (area(&marginal.prior), area(&marginal.posterior));
            let name = &marginal.parameter.name;
            assert!((0.8..1.03).contains(&before), "{name}: prior {before}");
            assert!((0.9..1.03).contains(&after), "{name}: posterior {after}");
            assert!(marginal.q05 < marginal.q50 && marginal.q50 < marginal.q95);
        }
    }
}
