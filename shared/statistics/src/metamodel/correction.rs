//! The correction of the low-fidelity (coarse) model: a regression of the difference `fine - coarse` on the parameters, where the
//! fine model is the high-fidelity one.

use nalgebra::{Cholesky, DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::covariance::CovarianceFactor;
use super::pool::{ModelPair, Pool};

/// Effective number of states for each coefficient of a regression.
const STATES_PER_COEFFICIENT: f64 = 4.0;
/// Ridge on the diagonal of the normal equations, whose features are of order one: it gives a direction in which the pool
/// has no extent the slope 0.
const RIDGE: f64 = 1e-9;

/// The correction of the coarse model: for each predicted value, the mean of `fine - coarse` as a polynomial in whitened coordinates.
///
/// The whitened coordinates are `w = A^-1 (u - m)`, m and A A' mean and covariance of the pool. Beyond `|w| = sqrt(d) + 2`,
/// outside the data, the correction has the value at that border, because a polynomial must not extrapolate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Correction {
    degree: Degree,
    /// A coefficient for each feature, by predicted value.
    coefficients: Vec<Vec<f64>>,
    /// Residual standard deviation of the regression, by predicted value.
    residual_sd: Vec<f64>,
}

/// Highest power of the polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Degree {
    Constant,
    Linear,
    Quadratic,
}

impl Degree {
    fn features(self, w: &[f64]) -> Vec<f64> {
        let mut features = vec![1.0];
        if self != Self::Constant {
            features.extend_from_slice(w);
        }
        if self == Self::Quadratic {
            for (i, a) in w.iter().enumerate() {
                features.extend(w[i..].iter().map(|b| a * b));
            }
        }
        features
    }

    fn count(self, dimension: usize) -> usize {
        match self {
            Self::Constant => 1,
            Self::Linear => 1 + dimension,
            Self::Quadratic => 1 + dimension + dimension * (dimension + 1) / 2,
        }
    }
}

/// Whitened coordinates, pair and weight of a state.
type WeightedPair<'a> = (Vec<f64>, &'a ModelPair, f64);

impl Correction {
    /// Fits weighted least squares of the highest degree that the pool supports; `None` if it supports none.
    ///
    /// Checked by `metamodel::a_quadratic_difference_is_found` and `metamodel::the_posterior_is_that_of_the_fine_model`.
    pub(super) fn fit(pool: &Pool, weights: &[f64], factor: &CovarianceFactor) -> Option<Self> {
        let pairs: Vec<WeightedPair> = pool
            .states
            .iter()
            .zip(weights)
            .filter_map(|(state, &weight)| {
                let pair = state.pair.as_deref()?;
                Some((clamped_to_pool(factor.whiten(&state.coordinates)?), pair, weight))
            })
            .collect();
        let squares: f64 = pairs.iter().map(|(_, _, w)| w * w).sum();
        let sum: f64 = pairs.iter().map(|(_, _, w)| w).sum();
        // After a rejected proposal a chain repeats its state, so a pool holds many copies.
        let effective = if squares > 0.0 { sum * sum / squares } else { 0.0 };
        [Degree::Quadratic, Degree::Linear, Degree::Constant]
            .into_iter()
            .filter(|degree| STATES_PER_COEFFICIENT * degree.count(factor.dimension()) as f64 <= effective)
            .find_map(|degree| Self::with_degree(degree, &pairs, sum, effective))
    }

    fn with_degree(degree: Degree, pairs: &[WeightedPair], sum: f64, effective: f64) -> Option<Self> {
        let features: Vec<Vec<f64>> = pairs.iter().map(|(w, _, _)| degree.features(w)).collect();
        let count = features.first()?.len();
        let values = pairs.first()?.1.fine.len();
        let mut normal = DMatrix::<f64>::zeros(count, count);
        for (row, (_, _, weight)) in features.iter().zip(pairs) {
            for i in 0..count {
                let scaled = weight / sum * row[i];
                for j in 0..=i {
                    normal[(i, j)] += scaled * row[j];
                }
            }
        }
        for i in 0..count {
            normal[(i, i)] += RIDGE;
        }
        // Only the lower triangle is read.
        let cholesky = Cholesky::new(normal)?;
        let mut coefficients = Vec::with_capacity(values);
        let mut residual_sd = Vec::with_capacity(values);
        let variance_inflation = effective / (effective - count as f64);
        for value in 0..values {
            let mut right_side = DVector::<f64>::zeros(count);
            for (row, (_, pair, weight)) in features.iter().zip(pairs) {
                let scaled = weight / sum * (pair.fine[value] - pair.coarse[value]);
                for (target, feature) in right_side.iter_mut().zip(row) {
                    *target += scaled * feature;
                }
            }
            let solution: Vec<f64> = cholesky.solve(&right_side).iter().copied().collect();
            let residual_variance: f64 = features
                .iter()
                .zip(pairs)
                .map(|(row, (_, pair, weight))| {
                    let off = pair.fine[value] - pair.coarse[value] - dot(row, &solution);
                    weight / sum * off * off
                })
                .sum();
            coefficients.push(solution);
            residual_sd.push((residual_variance * variance_inflation).sqrt());
        }
        let finite = coefficients
            .iter()
            .flatten()
            .chain(&residual_sd)
            .all(|x| x.is_finite());
        finite.then_some(Self {
            degree,
            coefficients,
            residual_sd,
        })
    }

    /// Returns the residual standard deviation of the regression, by predicted value.
    pub(super) fn residual_sd(&self) -> &[f64] {
        &self.residual_sd
    }

    /// Corrects the coarse model's values at these coordinates.
    pub(super) fn apply(&self, factor: &CovarianceFactor, coordinates: &[f64], values: &mut [f64]) {
        let Some(whitened) = factor.whiten(coordinates) else {
            return;
        };
        let features = self.degree.features(&clamped_to_pool(whitened));
        for (value, coefficients) in values.iter_mut().zip(&self.coefficients) {
            *value += dot(&features, coefficients);
        }
    }
}

/// Returns whitened coordinates, moved to the border of the pool's region if they lie beyond it.
fn clamped_to_pool(mut whitened: Vec<f64>) -> Vec<f64> {
    let radius = whitened.iter().map(|w| w * w).sum::<f64>().sqrt();
    let border = (whitened.len() as f64).sqrt() + 2.0;
    if radius > border {
        whitened.iter_mut().for_each(|w| *w *= border / radius);
    }
    whitened
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
