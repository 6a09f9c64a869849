//! Where fits of a formula start.

use crate::prior::{CONSTANT_SD, PARAMETERS};
use crate::program::ConstantRole;

/// Starts that are tried, by the number of constants.
const STARTS: [usize; PARAMETERS] = [1, 12, 24, 40];

/// Lists starts: an even sequence over the prior, with a threshold in each gap between points.
///
/// # Arguments
/// - `points`: of the curve, over the greatest magnitude of the variable.
pub(crate) fn starts(roles: &[ConstantRole], points: &[f64]) -> Vec<[f64; PARAMETERS]> {
    let threshold = roles.iter().position(|role| *role == ConstantRole::Threshold);
    let others = roles.len() - usize::from(threshold.is_some());
    let gaps = if threshold.is_some() { points.len() - 1 } else { 1 };
    let per_gap = match threshold {
        Some(_) => [1, 4, 8, 8][others],
        None => STARTS[others],
    };
    let mut starts = Vec::with_capacity(gaps * per_gap);
    for gap in 0..gaps {
        for index in 0..per_gap {
            let mut place = [0.0; PARAMETERS];
            let mut dimension = 0;
            for (k, role) in roles.iter().enumerate() {
                place[k + 1] = match role {
                    ConstantRole::Threshold => 0.5 * (points[gap] + points[gap + 1]),
                    _ => {
                        dimension += 1;
                        CONSTANT_SD * normal_quantile(even(index + 1, dimension - 1))
                    }
                };
            }
            starts.push(place);
        }
    }
    starts
}

/// Returns a number of Halton's sequence, in 0 to 1.
fn even(index: usize, dimension: usize) -> f64 {
    let base = [2, 3, 5][dimension];
    let (mut rest, mut share, mut value) = (index, 1.0, 0.0);
    while rest > 0 {
        share /= base as f64;
        value += share * (rest % base) as f64;
        rest /= base;
    }
    value
}

/// Returns a quantile of the standard normal distribution, to 0.02: it places starts alone (Hastings 1955, 26.2.22).
fn normal_quantile(p: f64) -> f64 {
    let tail = p.min(1.0 - p);
    let t = libm::sqrt(-2.0 * libm::log(tail));
    let z = t - (2.30753 + 0.27061 * t) / (1.0 + 0.99229 * t + 0.04481 * t * t);
    if p < 0.5 { -z } else { z }
}
