//! The multivariate t density from which importance sampling draws positions.

use nalgebra::{Cholesky, DMatrix, DVector};

use statistics::rng::Stream;

/// Degrees of freedom: the tails are heavier than those of a normal posterior.
const FREEDOM: usize = 6;

/// A multivariate t with 6 degrees of freedom.
#[derive(Debug, Clone)]
pub(crate) struct Student {
    mean: DVector<f64>,
    /// Lower factor of the scale matrix.
    factor: DMatrix<f64>,
    /// Log density at the mean.
    highest: f64,
}

impl Student {
    /// Makes the density; `None` where the scale matrix `[d, d]` is not positive definite.
    pub(crate) fn new(mean: DVector<f64>, scale: DMatrix<f64>) -> Option<Self> {
        let factor = Cholesky::new(scale)?.l();
        let (d, nu) = (mean.len() as f64, FREEDOM as f64);
        let log_determinant: f64 = (0..mean.len()).map(|k| libm::log(factor[(k, k)])).sum();
        let highest = libm::lgamma(0.5 * (nu + d))
            - libm::lgamma(0.5 * nu)
            - 0.5 * d * libm::log(nu * std::f64::consts::PI)
            - log_determinant;
        Some(Self {
            mean,
            factor,
            highest,
        })
    }

    pub(crate) fn scale(&self) -> DMatrix<f64> {
        &self.factor * self.factor.transpose()
    }

    pub(crate) fn draw(&self, stream: &mut Stream) -> Vec<f64> {
        let dimension = self.mean.len();
        let normals = stream.normals(dimension + FREEDOM);
        let (z, rest) = normals.split_at(dimension);
        let stretch = FREEDOM as f64 / rest.iter().map(|x| x * x).sum::<f64>();
        let z = DVector::from_column_slice(z) * stretch.sqrt();
        (&self.mean + &self.factor * z).iter().copied().collect()
    }

    pub(crate) fn log_density(&self, position: &[f64]) -> f64 {
        let off = DVector::from_column_slice(position) - &self.mean;
        let squares = self
            .factor
            .solve_lower_triangular(&off)
            .map_or(f64::INFINITY, |z| z.norm_squared());
        let (d, nu) = (position.len() as f64, FREEDOM as f64);
        self.highest - 0.5 * (nu + d) * libm::log1p(squares / nu)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_in_one_dimension_is_that_of_the_t() {
        let student = Student::new(DVector::from_element(1, 2.0), DMatrix::from_element(1, 1, 9.0)).unwrap();
        // Gamma(7/2) / (Gamma(3) sqrt(6 pi)) (1 + x^2/6)^(-7/2), at x = 0 and 1, over the scale 3.
        let at = |x: f64| libm::exp(student.log_density(&[2.0 + 3.0 * x]));
        let highest = 15.0 * std::f64::consts::PI.sqrt() / 8.0 / 2.0 / (6.0 * std::f64::consts::PI).sqrt();
        assert!((at(0.0) - highest / 3.0).abs() < 1e-12);
        assert!((at(1.0) - highest / 3.0 * libm::pow(7.0 / 6.0, -3.5)).abs() < 1e-12);
    }
}
