//! Whitening of residuals and derivatives, for a fit by least squares.

use super::common_error::ErrorBlock;
use super::datum::LikelihoodError;
use super::error_model::Likelihood;
use super::factor::CholeskyFactor;
use super::law::ErrorLaw;
use super::spread::CERTAIN;

/// A value of the discrepancy with less probability moves no slope and no curvature visibly.
const LEAST_PROBABILITY: f64 = 1e-12;

/// The linear transform to independent errors of sd 1, at one point.
///
/// With W the transform, r the residuals and c, d the derivatives of the predictions along two directions, the
/// log-likelihood has the slope `sum_i a_i (W c)_i (W r)_i` along c and, in expectation, the curvature
/// `-sum_i b_i (W c)_i (W d)_i`, with the weights a and b of the law: 1 for normal errors. The covariance is held
/// constant; its change would need second derivatives. An unknown discrepancy enters with every value of m, weighted by
/// its posterior probability: the slope is exact, the curvature that of expectation-maximisation.
#[derive(Debug, Clone)]
pub struct Whitening {
    alone: Vec<(usize, f64)>,
    blocks: Vec<(Vec<usize>, CholeskyFactor)>,
    residuals: Vec<f64>,
    slope_weights: Vec<f64>,
    curvature_weights: Vec<f64>,
}

impl Likelihood {
    /// The transform at these predicted values.
    ///
    /// # Errors
    /// Those of [`Likelihood::log_likelihood`]. Checked by `likelihood::whitened_slopes_are_those_of_the_density`.
    pub fn whitening(&self, values: &[f64], theta: &[f64]) -> Result<Whitening, LikelihoodError> {
        let mut whitening = Whitening {
            alone: Vec::with_capacity(self.alone.len()),
            blocks: Vec::new(),
            residuals: Vec::with_capacity(self.data.len()),
            slope_weights: Vec::with_capacity(self.data.len()),
            curvature_weights: Vec::with_capacity(self.data.len()),
        };
        for &i in &self.alone {
            let sd = self.data[i].noise_sd(theta)?;
            let residual = (self.data[i].value - values[i]) / sd;
            whitening.alone.push((i, sd));
            whitening.push(&[residual], residual * residual, self.law, 1.0);
        }
        let families = self.family_weights(values, theta)?;
        for block in &self.blocks {
            let levels = block.family.map_or(&CERTAIN[..], |family| &families[family]);
            for &(m, probability) in levels {
                if probability > LEAST_PROBABILITY {
                    self.whiten_block(block, m, probability, values, theta, &mut whitening)?;
                }
            }
        }
        Ok(whitening)
    }

    fn whiten_block(
        &self,
        block: &ErrorBlock,
        m: f64,
        probability: f64,
        values: &[f64],
        theta: &[f64],
        whitening: &mut Whitening,
    ) -> Result<(), LikelihoodError> {
        if let Some(scored) = self.score(block, m, values, theta)? {
            whitening.push(&scored.whitened, scored.squared_distance, self.law, probability);
            whitening.blocks.push((block.data.clone(), scored.factor));
        }
        Ok(())
    }
}

impl Whitening {
    /// The sum of the squared residuals.
    pub fn squared_residuals(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }

    fn push(&mut self, residuals: &[f64], squared_distance: f64, law: ErrorLaw, probability: f64) {
        let [slope, curvature] = law.weights(residuals.len(), squared_distance);
        self.residuals.extend(residuals);
        for _ in residuals {
            self.slope_weights.push(probability * slope);
            self.curvature_weights.push(probability * curvature);
        }
    }

    /// W v, with one element of v for each datum; further elements are ignored.
    #[must_use]
    pub fn apply(&self, v: &[f64]) -> Vec<f64> {
        let mut whitened: Vec<f64> = self.alone.iter().map(|&(i, sd)| v[i] / sd).collect();
        for (data, factor) in &self.blocks {
            whitened.extend(factor.whiten(data.iter().map(|&i| v[i]).collect()));
        }
        whitened
    }

    /// `sum_i a_i (W c)_i (W r)_i` of an applied c.
    #[must_use]
    pub fn slope(&self, c: &[f64]) -> f64 {
        let terms = c.iter().zip(&self.residuals).zip(&self.slope_weights);
        terms.map(|((x, y), weight)| x * y * weight).sum()
    }

    /// `sum_i b_i (W c)_i (W d)_i` of applied c and d.
    #[must_use]
    pub fn curvature(&self, c: &[f64], d: &[f64]) -> f64 {
        let terms = c.iter().zip(d).zip(&self.curvature_weights);
        terms.map(|((x, y), weight)| x * y * weight).sum()
    }
}
