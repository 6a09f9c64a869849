//! The process, and its mean between the measurements.

use nalgebra::{Cholesky, DVector};

use super::kernel::Kernel;
use super::observation::Observation;
use super::smoothness::smoothest;
use super::unit_range::UnitRange;

/// A Gaussian process through observations: a plane and a smooth process about it.
///
/// `y(x) = a + b'x + f(x) + e`, with `f` of the covariance `s^2 (1 + r + r^2 / 3) exp(-r)`, `r^2 = 5 sum_k ((x_k - x'_k) /
/// l_k)^2` (Matérn, 5/2), coordinates over their range, and noise `e` of the variance `s^2 q / repeats`. Between observations the
/// mean interpolates; beyond them it returns to the plane. The `l_k`, from 0.1 to 3.2 of the range, and `q`, from 1e-4 to 1, are
/// those with the smallest squared error of the observations when each is left out; with more than 150 observations, of 150 that
/// represent every level of every coordinate. A coordinate of two levels has the longest `l_k`: between them the process is
/// nearly straight.
///
/// # Source
/// Rasmussen & Williams 2006, Gaussian Processes for Machine Learning, Eqs. 2.25, 4.17 (covariance) and 5.12 (leaving one out),
/// <https://doi.org/10.7551/mitpress/3206.001.0001>. Checked by `the_process_interpolates_a_smooth_surface` and others below.
#[derive(Debug, Clone)]
pub struct GaussianProcess {
    unit: UnitRange,
    mean: f64,
    observations: Vec<Observation>,
    kernel: Kernel,
    weights: DVector<f64>,
}

impl GaussianProcess {
    /// Returns the minimum number of observations for this number of coordinates: those that determine a plane, and one more.
    #[must_use]
    pub fn min_observations(coordinates: usize) -> usize {
        coordinates + 2
    }

    /// Returns the process through observations of points that all have the same coordinates, each of which must vary; `None`
    /// with fewer than [`GaussianProcess::min_observations`], or where their covariance is singular to rounding.
    #[must_use]
    pub fn through(observations: &[Observation]) -> Option<Self> {
        let dimension = observations.first()?.point.len();
        if observations.len() < Self::min_observations(dimension) {
            return None;
        }
        let points: Vec<&[f64]> = observations.iter().map(|o| o.point.as_slice()).collect();
        let unit = UnitRange::new(&points);
        let mean = observations.iter().map(|o| o.value).sum::<f64>() / observations.len() as f64;
        let scaled = |o: &Observation| Observation {
            point: unit.scaled(&o.point),
            value: o.value - mean,
            repeats: o.repeats,
        };
        let observations: Vec<Observation> = observations.iter().map(scaled).collect();
        let kernel = smoothest(&observations, dimension);
        let factor = Cholesky::new(kernel.matrix(&observations))?;
        let values = DVector::from_iterator(observations.len(), observations.iter().map(|o| o.value));
        let weights = factor.solve(&values);
        Some(GaussianProcess {
            unit,
            mean,
            observations,
            kernel,
            weights,
        })
    }

    /// Returns the mean of the process at a point [unit of the values].
    #[must_use]
    pub fn mean(&self, point: &[f64]) -> f64 {
        let point = self.unit.scaled(point);
        let terms = self.observations.iter().zip(self.weights.iter());
        let sum: f64 = terms
            .map(|(o, weight)| weight * self.kernel.covariance(&o.point, &point))
            .sum();
        self.mean + sum
    }

    /// Returns whether a point lies within the range of the observations in every coordinate, up to 2 % of it.
    #[must_use]
    pub fn reaches(&self, point: &[f64]) -> bool {
        let point = self.unit.scaled(point);
        point.iter().all(|x| (-0.02..=1.02).contains(x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Observations on a grid of slip and angle, in the units of a rig.
    fn grid(value: impl Fn(f64, f64) -> f64) -> Vec<Observation> {
        let slips = (0..8).map(|i| -0.7 + 0.2 * f64::from(i));
        let points = slips.flat_map(|slip| (0..5).map(move |j| vec![slip, 15.0 * f64::from(j)]));
        points
            .map(|point| Observation {
                value: value(point[0], point[1]),
                point,
                repeats: 1,
            })
            .collect()
    }

    #[test]
    fn the_process_interpolates_a_smooth_surface() {
        let surface = |slip: f64, angle: f64| 30.0 * libm::tanh(2.0 * slip) + 0.3 * angle * (1.0 + slip);
        let process = GaussianProcess::through(&grid(surface)).unwrap();
        for point in [[-0.4, 22.0], [0.0, 50.0], [0.6, 7.0]] {
            let error = process.mean(&point) - surface(point[0], point[1]);
            // A share of a range of 85.
            assert!(error.abs() < 0.8, "{point:?}: {error}");
        }
        assert!(process.reaches(&[0.0, 60.5]) && !process.reaches(&[0.0, 75.0]));
    }

    #[test]
    fn a_plane_is_kept_and_extrapolated() {
        let plane = |slip: f64, angle: f64| 2.0 - 5.0 * slip + 0.1 * angle;
        let process = GaussianProcess::through(&grid(plane)).unwrap();
        for point in [[0.1, 33.0], [0.2, 75.0]] {
            let error = process.mean(&point) - plane(point[0], point[1]);
            assert!(error.abs() < 0.01, "{point:?}: {error}");
        }
    }

    #[test]
    fn noise_is_smoothed_and_repeats_count() {
        let noisy = |slip: f64, angle: f64| {
            let sign = if (libm::round(5.0 * slip) + libm::round(angle / 15.0)) as i64 % 2 == 0 {
                1.0
            } else {
                -1.0
            };
            10.0 * slip + sign
        };
        let process = GaussianProcess::through(&grid(noisy)).unwrap();
        let error = process.mean(&[0.1, 30.0]) - 1.0;
        assert!(error.abs() < 0.5, "{error}: the noise is 1");
        let mut sure = grid(noisy);
        sure[20].repeats = 10_000;
        let (point, value) = (sure[20].point.clone(), sure[20].value);
        let with = GaussianProcess::through(&sure).unwrap();
        assert!((with.mean(&point) - value).abs() < (process.mean(&point) - value).abs());
    }

    #[test]
    fn too_few_observations_make_no_process() {
        let few = &grid(|slip, _| slip)[4..7];
        assert_eq!(GaussianProcess::min_observations(2), 4);
        assert!(GaussianProcess::through(few).is_none() && GaussianProcess::through(&[]).is_none());
    }
}
