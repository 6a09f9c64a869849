//! Correlations of jointly normal parameters.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::error::PriorError;
use super::marginal::Marginal;

/// Correlations of parameters whose marginals are normal and untruncated: together they are jointly normal.
///
/// With z the standardised values, R the correlations and d their number, the joint density is the product of the
/// marginals times `|R|^(-1/2) exp(-z' (R^-1 - I) z / 2)`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Correlation {
    /// The parameters, ascending.
    parameters: Vec<usize>,
    /// Correlation matrix R.
    correlations: Vec<Vec<f64>>,
    /// L of R = L L'.
    factor: DMatrix<f64>,
    /// The matrix R^-1 - I of the exponent of the joint density.
    excess: DMatrix<f64>,
    /// Logarithm of the normalisation of the joint density, -ln|R| / 2.
    log_volume: f64,
}

/// Slope and curvature by parameter, in units of the marginals' standard deviations.
#[derive(Debug, Default)]
pub struct CorrelationSlopes {
    /// Slope by position of the parameter.
    pub slopes: Vec<(usize, f64)>,
    /// Curvature by positions of both parameters.
    pub curvatures: Vec<(usize, usize, f64)>,
}

impl Correlation {
    /// Builds the correlations of some of the marginals.
    ///
    /// # Errors
    /// [`PriorError::NotNormal`], [`PriorError::NotACorrelation`].
    pub(super) fn new(
        marginals: &[Marginal],
        parameters: Vec<usize>,
        correlations: &[Vec<f64>],
    ) -> Result<Self, PriorError> {
        let count = parameters.len();
        let ascending = parameters.windows(2).all(|pair| pair[0] < pair[1]);
        let square = correlations.len() == count && correlations.iter().all(|row| row.len() == count);
        if !ascending || !square {
            return Err(PriorError::NotACorrelation);
        }
        for &parameter in &parameters {
            let normal = marginals.get(parameter).and_then(Marginal::untruncated_normal);
            if normal.is_none() {
                return Err(PriorError::NotNormal { parameter });
            }
        }
        let matrix = DMatrix::from_fn(count, count, |i, j| correlations[i][j]);
        let symmetric =
            (0..count).all(|i| (0..i).all(|j| matrix[(i, j)].to_bits() == matrix[(j, i)].to_bits()));
        let has_unit_diagonal = (0..count).all(|i| (matrix[(i, i)] - 1.0).abs() < 1e-12);
        if !symmetric || !has_unit_diagonal {
            return Err(PriorError::NotACorrelation);
        }
        let cholesky = Cholesky::new(matrix).ok_or(PriorError::NotACorrelation)?;
        let factor = cholesky.l();
        let log_volume = -(0..count).map(|i| libm::log(factor[(i, i)])).sum::<f64>();
        let excess = cholesky.inverse() - DMatrix::identity(count, count);
        if !(log_volume.is_finite() && excess.iter().all(|x| x.is_finite())) {
            return Err(PriorError::NotACorrelation);
        }
        Ok(Self {
            parameters,
            correlations: correlations.to_vec(),
            factor,
            excess,
            log_volume,
        })
    }

    /// Returns the parameters and their correlations, as passed to [`Correlation::new`].
    pub(super) fn given(self) -> (Vec<usize>, Vec<Vec<f64>>) {
        (self.parameters, self.correlations)
    }

    /// Returns the contribution of the correlations to the log-density at sampling coordinates.
    pub(super) fn log_density(&self, marginals: &[Marginal], coordinates: &[f64]) -> f64 {
        let z = self.standardised(marginals, coordinates);
        self.log_volume - 0.5 * z.dot(&(&self.excess * &z))
    }

    /// Replaces the normal scores of the correlated parameters by independent ones, `L^-1 z`.
    pub(super) fn whiten(&self, scores: &mut [f64]) {
        let mut z = DVector::from_iterator(self.parameters.len(), self.parameters.iter().map(|&p| scores[p]));
        // The factor of a positive definite matrix has a positive diagonal.
        self.factor.solve_lower_triangular_mut(&mut z);
        for (&parameter, z) in self.parameters.iter().zip(z.iter()) {
            scores[parameter] = *z;
        }
    }

    /// Replaces independent normal scores of the correlated parameters by correlated ones, `L z`.
    pub(super) fn colour(&self, scores: &mut [f64]) {
        let z = DVector::from_iterator(self.parameters.len(), self.parameters.iter().map(|&p| scores[p]));
        for (&parameter, z) in self.parameters.iter().zip((&self.factor * z).iter()) {
            scores[parameter] = *z;
        }
    }

    /// Returns the correlations among the kept parameters, with new positions; `None` if fewer than two remain.
    pub(super) fn subset(self, marginals: &[Marginal], kept: &[usize]) -> Option<Self> {
        let (parameters, correlations) = self.given();
        let members: Vec<(usize, usize)> = (0..kept.len())
            .filter_map(|new| Some((new, parameters.iter().position(|&p| p == kept[new])?)))
            .collect();
        if members.len() < 2 {
            return None;
        }
        let row = |i: usize| members.iter().map(|&(_, j)| correlations[i][j]).collect();
        let correlations: Vec<Vec<f64>> = members.iter().map(|&(_, i)| row(i)).collect();
        let parameters = members.into_iter().map(|(new, _)| new).collect();
        // A principal submatrix of a correlation matrix is a correlation matrix.
        Self::new(marginals, parameters, &correlations).ok()
    }

    /// Replaces independent draws of the correlated parameters by correlated ones.
    pub(super) fn correlate(&self, marginals: &[Marginal], theta: &mut [f64]) {
        let coordinates: Vec<f64> = marginals
            .iter()
            .zip(&*theta)
            .map(|(m, &x)| m.coordinate(x))
            .collect();
        let z = &self.factor * self.standardised(marginals, &coordinates);
        for (&parameter, z) in self.parameters.iter().zip(z.iter()) {
            if let Some((mean, sd)) = marginals[parameter].untruncated_normal() {
                theta[parameter] = marginals[parameter].value(mean + sd * z);
            }
        }
    }

    /// Returns the contribution of the correlations to slope and curvature of -ln p at sampling coordinates, both in
    /// units of the marginals' standard deviations.
    pub(super) fn slopes(&self, marginals: &[Marginal], coordinates: &[f64]) -> CorrelationSlopes {
        let slope = &self.excess * self.standardised(marginals, coordinates);
        let parameters = self.parameters.iter().copied();
        let curvatures_of_row = |(i, k): (usize, usize)| {
            let pairs = self.parameters.iter().enumerate();
            pairs.map(move |(j, &l)| (k, l, self.excess[(i, j)]))
        };
        CorrelationSlopes {
            slopes: parameters.clone().zip(slope.iter().copied()).collect(),
            curvatures: parameters.enumerate().flat_map(curvatures_of_row).collect(),
        }
    }

    fn standardised(&self, marginals: &[Marginal], coordinates: &[f64]) -> DVector<f64> {
        let z = |&parameter: &usize| {
            let (mean, sd) = marginals[parameter].untruncated_normal().unwrap_or((0.0, 1.0));
            (coordinates[parameter] - mean) / sd
        };
        DVector::from_iterator(self.parameters.len(), self.parameters.iter().map(z))
    }
}
