//! The frame of an emulator: coordinates in which the present target has mean zero and unit covariance.

use nalgebra::{Cholesky, DMatrix};

/// Smallest eigenvalue share that a covariance is given, so that a direction without spread has a scale.
const MIN_RELATIVE_VARIANCE: f64 = 1e-14;

/// An affine transform to whitened coordinates, `u = L^-1 (x - c)` with the covariance `L L'`.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    center: Vec<f64>,
    /// L by rows, the lower triangle alone.
    factor: Vec<f64>,
}

impl Frame {
    /// Returns the frame of equally weighted points; `None` where they do not span the space.
    pub(crate) fn new<'a>(points: impl Iterator<Item = &'a [f64]> + Clone) -> Option<Self> {
        let dimension = points.clone().next()?.len();
        let count = points.clone().count() as f64;
        let mut center = vec![0.0; dimension];
        for x in points.clone() {
            for (sum, x) in center.iter_mut().zip(x) {
                *sum += x / count;
            }
        }
        let mut covariance = DMatrix::zeros(dimension, dimension);
        for x in points {
            for i in 0..dimension {
                for j in 0..=i {
                    covariance[(i, j)] += (x[i] - center[i]) * (x[j] - center[j]) / count;
                }
            }
        }
        for i in 0..dimension {
            covariance[(i, i)] *= 1.0 + MIN_RELATIVE_VARIANCE;
        }
        let factor = Cholesky::new(covariance)?.unpack();
        let rows = (0..dimension).flat_map(|i| (0..=i).map(move |j| (i, j)));
        Some(Self {
            factor: rows.map(|place| factor[place]).collect(),
            center,
        })
    }

    /// Returns the whitened coordinates of a point.
    pub(crate) fn whiten(&self, x: &[f64]) -> Vec<f64> {
        let mut u = Vec::with_capacity(x.len());
        let mut row = 0;
        for (x, c) in x.iter().zip(&self.center) {
            let factors = &self.factor[row..=row + u.len()];
            let known: f64 = factors.iter().zip(&u).map(|(l, u)| l * u).sum();
            row += factors.len();
            u.push((x - c - known) / factors[factors.len() - 1]);
        }
        u
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::rng::Stream;

    #[test]
    fn whitened_points_have_unit_covariance() {
        let draws = Stream::new(1, 0, 0, 0).normals(2000);
        let points: Vec<Vec<f64>> = draws
            .chunks_exact(2)
            .map(|z| vec![5.0 + 1e-6 * z[0], 1e4 * z[1] + 3e3 * z[0]])
            .collect();
        let frame = Frame::new(points.iter().map(Vec::as_slice)).unwrap();
        let whitened: Vec<Vec<f64>> = points.iter().map(|x| frame.whiten(x)).collect();
        let product = |i: usize, j: usize| whitened.iter().map(|u| u[i] * u[j]).sum::<f64>() / 1000.0;
        assert!((product(0, 0) - 1.0).abs() < 1e-6);
        assert!((product(1, 1) - 1.0).abs() < 1e-6);
        assert!(product(0, 1).abs() < 1e-6);
    }

    #[test]
    fn points_without_spread_have_no_frame() {
        let points = [vec![1.0, 2.0], vec![1.0, 3.0]];
        assert!(Frame::new(points.iter().map(Vec::as_slice)).is_none());
    }
}
