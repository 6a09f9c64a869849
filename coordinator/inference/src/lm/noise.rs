//! The most probable noise sd for given residuals.

use statistics::likelihood::{ErrorSd, Likelihood};
use statistics::prior::{Marginal, Prior};

/// Smallest noise sd as a share of the prior's sd, if the prior reaches down to 0: residuals of zero would make an sd of 0
/// infinitely probable.
const MIN_SHARE: f64 = 1e-9;
/// Cells of the grid on which the minimum is bracketed.
const CELLS: u32 = 64;
/// Bisections of the bracket: below one unit in the last place.
const HALVINGS: u32 = 80;

/// An inferred noise sd, and the data that share it.
#[derive(Debug, Clone)]
pub(super) struct InferredNoise {
    pub(super) parameter: usize,
    marginal: Marginal,
    data: Vec<usize>,
}

/// The most probable noise sd.
#[derive(Debug, Clone, Copy)]
pub(super) struct Profiled {
    pub(super) sd: f64,
    pub(super) at_bound: bool,
    /// Standard deviation of the noise sd itself, from the curvature along its logarithm; none at a bound.
    pub(super) uncertainty: Option<f64>,
}

impl InferredNoise {
    /// Returns the inferred noise sds of a likelihood, by ascending parameter.
    pub(super) fn all(prior: &Prior, likelihood: &Likelihood) -> Vec<Self> {
        let data = likelihood.data();
        prior
            .marginals()
            .iter()
            .enumerate()
            .filter_map(|(parameter, marginal)| {
                let sd = ErrorSd::Inferred { parameter };
                let data: Vec<usize> = (0..data.len()).filter(|&i| data[i].sd == sd).collect();
                (!data.is_empty()).then(|| Self {
                    parameter,
                    marginal: marginal.clone(),
                    data,
                })
            })
            .collect()
    }

    /// Minimises `n ln sd + S / (2 sd^2) - ln p(sd)` with S the sum of the squares of the n residuals.
    ///
    /// # Arguments
    /// - `residuals`: measured minus predicted for all data, each in its unit.
    ///
    /// # Returns
    /// The sd in the unit of its data. It lies between the optimum of the likelihood, sqrt(S/n), and the mode of the prior; along
    /// ln sd the minimum is bracketed on a grid and refined by bisection. Checked by `lm::noise_has_its_closed_form`.
    pub(super) fn profile(&self, residuals: &[f64]) -> Profiled {
        let squares: f64 = self.data.iter().map(|&i| residuals[i] * residuals[i]).sum();
        let count = self.data.len() as f64;
        let (lower, upper) = self.marginal.support();
        let lower = lower.max(MIN_SHARE * self.marginal.sd());
        let within = |sd: f64| sd.max(lower).min(upper);
        let likely = within((squares / count).sqrt());
        let usual = within(self.mode(lower, upper));
        let (lower_sd, upper_sd) = (likely.min(usual), likely.max(usual));
        let (low, high) = (libm::log(lower_sd), libm::log(upper_sd));
        let value = |v: f64| {
            let sd = libm::exp(v);
            count * v + 0.5 * squares / sd / sd - self.marginal.log_density(within(sd))
        };
        let slope = |v: f64| self.slope(v, count, squares).0;
        let node = |k: u32| low + (high - low) * f64::from(k) / f64::from(CELLS);
        let best = (0..=CELLS).reduce(|a, b| if value(node(b)) < value(node(a)) { b } else { a });
        let best = best.unwrap_or(0);
        let (mut left, mut right) = (node(best.saturating_sub(1)), node((best + 1).min(CELLS)));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (left + right);
            if slope(middle) > 0.0 {
                right = middle;
            } else {
                left = middle;
            }
        }
        let v = 0.5 * (left + right);
        // At an end the sd is taken as given, not from its logarithm, so that it equals the bound exactly.
        let sd = if best == 0 && slope(low) >= 0.0 {
            lower_sd
        } else if best == CELLS && slope(high) <= 0.0 {
            upper_sd
        } else {
            within(libm::exp(v))
        };
        let curvature = self.slope(v, count, squares).1;
        let at_bound = sd <= lower || sd >= upper;
        Profiled {
            sd,
            at_bound,
            uncertainty: (!at_bound && curvature > 0.0).then(|| sd / curvature.sqrt()),
        }
    }

    /// Returns the slope and curvature of the objective along v = ln sd.
    fn slope(&self, v: f64, count: f64, squares: f64) -> (f64, f64) {
        let sd = libm::exp(v);
        let ratio = squares / sd / sd;
        let (slope, curvature) = self.marginal.slope(self.marginal.coordinate(sd));
        // u is v, or sd itself.
        let rate = sd / self.marginal.rate(sd);
        let bend = if self.marginal.is_logarithmic() {
            0.0
        } else {
            sd * slope
        };
        (
            count - ratio + rate * slope,
            2.0 * ratio + rate * rate * curvature + bend,
        )
    }

    /// Returns the mode of the prior between two sds.
    fn mode(&self, lower: f64, upper: f64) -> f64 {
        let (slope, curvature) = self.marginal.slope(0.0);
        if curvature > 0.0 {
            self.marginal.value(-slope / curvature)
        } else if slope > 0.0 {
            lower
        } else {
            // The density is flat, so any value bounds the search together with the optimum of the likelihood.
            0.5 * (lower + upper)
        }
    }
}
