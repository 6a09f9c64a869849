//! The model as a linear one over a normal distribution, by differences of the second order.

use nalgebra::{Cholesky, DMatrix, DVector};
use statistics::prior::LN_SQRT_TAU;

use super::gaussian::Gaussian;

/// Distance of the points from the mean, in standard deviations along each axis: the fourth moment of a normal distribution.
const DISTANCE: f64 = 1.732_050_807_568_877_2;
/// Number of times that the distance is halved where the model refuses a point.
const MAX_HALVINGS: usize = 4;
/// Share of the prior's variance below which an axis is not resolved: it keeps the covariance positive definite.
const LEAST_VARIANCE: f64 = 1e-12;

/// Values of the model as `slopes x + offset + e`, where `e` has the covariance `error`.
#[derive(Debug, Clone)]
pub(super) struct Linearisation {
    pub(super) slopes: DMatrix<f64>,
    pub(super) offset: DVector<f64>,
    pub(super) error: DMatrix<f64>,
}

impl Linearisation {
    /// Evaluates the model at the mean and at two points on each axis; `None` where the model refuses the mean or its neighbours.
    ///
    /// # Arguments
    /// - `model`: from scores to values; `None` where it refuses them.
    ///
    /// # Source
    /// Nørgaard, Poulsen & Ravn 2000, Automatica 36:1627, doi:10.1016/S0005-1098(00)00089-3. Checked by
    /// `tests::a_square_has_its_mean_and_variance`.
    pub(super) fn over(
        gaussian: &Gaussian,
        model: &mut dyn FnMut(&DVector<f64>) -> Option<Vec<f64>>,
    ) -> Option<Self> {
        let dimension = gaussian.mean.len();
        let mut covariance = gaussian.covariance.clone();
        (0..dimension).for_each(|i| covariance[(i, i)] += LEAST_VARIANCE);
        let axes = Cholesky::new(covariance)?.unpack();
        let centre = DVector::from_vec(model(&gaussian.mean)?);
        let mut distance = DISTANCE;
        for _ in 0..=MAX_HALVINGS {
            let mut pairs = Vec::with_capacity(dimension);
            for axis in axes.column_iter() {
                let step = axis * distance;
                let above = model(&(&gaussian.mean + &step));
                let Some(above) = above else { break };
                let Some(below) = model(&(&gaussian.mean - &step)) else {
                    break;
                };
                pairs.push((DVector::from_vec(above), DVector::from_vec(below)));
            }
            if pairs.len() == dimension {
                return Self::through(gaussian, &axes, &centre, &pairs, distance);
            }
            distance *= 0.5;
        }
        None
    }

    fn through(
        gaussian: &Gaussian,
        axes: &DMatrix<f64>,
        centre: &DVector<f64>,
        pairs: &[(DVector<f64>, DVector<f64>)],
        distance: f64,
    ) -> Option<Self> {
        let count = centre.len();
        let mut along = DMatrix::zeros(count, pairs.len());
        let mut mean = centre.clone();
        let mut error = DMatrix::zeros(count, count);
        for (axis, (above, below)) in pairs.iter().enumerate() {
            along.set_column(axis, &((above - below) / (2.0 * distance)));
            let curvature = (above + below - centre * 2.0) / (distance * distance);
            mean += &curvature * 0.5;
            error += &curvature * curvature.transpose() * 0.5;
        }
        // The slopes along the axes L are those along the scores times L.
        let slopes = axes
            .transpose()
            .solve_upper_triangular(&along.transpose())?
            .transpose();
        Some(Linearisation {
            offset: mean - &slopes * &gaussian.mean,
            slopes,
            error,
        })
    }
}

impl Gaussian {
    /// Returns the distribution given measured values, and the log-density of these; `None` where rounding leaves no covariance.
    ///
    /// # Arguments
    /// - `variances`: of the measured values.
    pub(super) fn updated(
        &self,
        model: &Linearisation,
        values: &DVector<f64>,
        variances: &DVector<f64>,
    ) -> Option<(Self, f64)> {
        let crossed = &self.covariance * model.slopes.transpose();
        let spread = &model.slopes * &crossed + &model.error + DMatrix::from_diagonal(variances);
        let factor = Cholesky::new(spread)?;
        let misfit = values - (&model.slopes * &self.mean + &model.offset);
        let weighted = factor.solve(&misfit);
        let log_density = -0.5 * misfit.dot(&weighted)
            - (0..values.len())
                .map(|i| libm::log(factor.l_dirty()[(i, i)]) + LN_SQRT_TAU)
                .sum::<f64>();
        let mean = &self.mean + &crossed * weighted;
        let less = &crossed * factor.solve(&crossed.transpose());
        let covariance = &self.covariance - less;
        let covariance = 0.5 * (&covariance + covariance.transpose());
        let is_valid = log_density.is_finite() && (0..mean.len()).all(|i| covariance[(i, i)] >= 0.0);
        is_valid.then_some((Gaussian { mean, covariance }, log_density))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_its_mean_and_variance() {
        let gaussian = Gaussian {
            mean: DVector::from_vec(vec![1.0]),
            covariance: DMatrix::from_vec(1, 1, vec![0.25]),
        };
        let mut square = |x: &DVector<f64>| Some(vec![x[0] * x[0]]);
        let linear = Linearisation::over(&gaussian, &mut square).expect("a linearisation");
        // E x^2 = mean^2 + variance; the variance beyond the linear part is 2 variance^2.
        let mean = linear.slopes[(0, 0)] + linear.offset[0];
        assert!((mean - 1.25).abs() < 1e-9 && (linear.slopes[(0, 0)] - 2.0).abs() < 1e-9);
        assert!((linear.error[(0, 0)] - 0.125).abs() < 1e-9, "{linear:?}");
    }

    #[test]
    fn a_model_that_refuses_points_is_linearised_nearer_to_the_mean() {
        let gaussian = Gaussian {
            mean: DVector::from_vec(vec![0.0]),
            covariance: DMatrix::from_vec(1, 1, vec![1.0]),
        };
        let mut bounded = |x: &DVector<f64>| (x[0] < 0.5).then(|| vec![3.0 * x[0]]);
        let linear = Linearisation::over(&gaussian, &mut bounded).expect("a linearisation");
        assert!((linear.slopes[(0, 0)] - 3.0).abs() < 1e-9);
        assert!(Linearisation::over(&gaussian, &mut |_: &DVector<f64>| None).is_none());
    }
}
