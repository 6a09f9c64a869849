//! Whitening of residuals and derivatives, for a fit by least squares.

use super::common_error::ErrorBlock;
use super::common_shift::CommonShift;
use super::datum::LikelihoodError;
use super::error_model::Likelihood;
use super::factor::CovarianceFactor;
use super::law::ErrorLaw;
use super::spread::CERTAIN;

/// Probability of a value of the discrepancy below which it changes slope and curvature by less than rounding, and is left out.
const MIN_PROBABILITY: f64 = 1e-12;

/// The linear transform of errors to independent ones of sd 1, at one point.
///
/// With W the transform, r the residuals and c, d the derivatives of the predictions along two directions, the
/// log-likelihood has the slope `sum_i a_i (W c)_i (W r)_i` along c and, in expectation, the curvature
/// `-sum_i b_i (W c)_i (W d)_i`, with the weights a and b of the law: 1 for normal errors. The covariance is held
/// constant; its change would need second derivatives. An unknown discrepancy enters with every value of m, weighted by
/// its posterior probability: the slope is exact, the curvature that of expectation-maximisation.
#[derive(Debug, Clone)]
pub struct Whitening {
    alone: Vec<(usize, f64)>,
    blocks: Vec<(Vec<usize>, BlockTransform)>,
    residuals: Vec<f64>,
    slope_weights: Vec<f64>,
    curvature_weights: Vec<f64>,
}

#[derive(Debug, Clone)]
enum BlockTransform {
    Factor(CovarianceFactor),
    Shift(ShiftTransform),
}

/// The transform of normal errors that share one shift, averaged over the sizes that an unknown discrepancy may have.
///
/// With D the noise sds and q the unit vector along `D^-1 1`, the precision of a size m is `D^-1 (I - (1 - k_m) q q') D^-1` with
/// `k_m = 1 / (1 + m^2 u^2 w)`, so their mean has the mean k, and its root is `(I - (1 - sqrt(k)) q q') D^-1`.
///
/// # Source
/// Sherman & Morrison 1950, doi:10.1214/aoms/1177729893. Checked by `likelihood::a_common_shift_is_whitened_by_its_mean_precision`.
#[derive(Debug, Clone)]
struct ShiftTransform {
    sds: Vec<f64>,
    along: Vec<f64>,
    /// Share that whitening takes from the mean, `1 - sqrt(k)`.
    taken: f64,
}

impl ShiftTransform {
    /// # Arguments
    /// - `levels`: the values of m with their posterior probabilities.
    fn new(sds: Vec<f64>, shift: &CommonShift, levels: &[(f64, f64)]) -> Self {
        let kept: f64 = levels
            .iter()
            .map(|(m, probability)| probability * shift.kept(*m))
            .sum();
        let squares: f64 = sds.iter().map(|sd| 1.0 / (sd * sd)).sum();
        Self {
            along: sds.iter().map(|sd| 1.0 / (sd * squares.sqrt())).collect(),
            sds,
            taken: 1.0 - kept.sqrt(),
        }
    }

    fn whiten(&self, mut v: Vec<f64>) -> Vec<f64> {
        for (v, sd) in v.iter_mut().zip(&self.sds) {
            *v /= sd;
        }
        let shift: f64 = v.iter().zip(&self.along).map(|(v, q)| v * q).sum();
        for (v, q) in v.iter_mut().zip(&self.along) {
            *v -= self.taken * shift * q;
        }
        v
    }
}

impl Likelihood {
    /// Returns the transform at these predicted values.
    ///
    /// # Errors
    /// As for [`Likelihood::log_likelihood`]. Checked by `likelihood::whitened_slopes_are_those_of_the_density`.
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
            if let (Some(family), ErrorLaw::Gaussian) = (block.family, self.law)
                && let Some(shift) = self.common_shift(block, values, theta)?
            {
                let sds: Result<Vec<f64>, _> =
                    block.data.iter().map(|&i| self.data[i].noise_sd(theta)).collect();
                let transform = ShiftTransform::new(sds?, &shift, &families[family]);
                let residuals = block.data.iter().map(|&i| self.data[i].value - values[i]);
                let whitened = transform.whiten(residuals.collect());
                let squared_distance = whitened.iter().map(|r| r * r).sum();
                whitening.push(&whitened, squared_distance, self.law, 1.0);
                whitening
                    .blocks
                    .push((block.data.clone(), BlockTransform::Shift(transform)));
                continue;
            }
            let levels = block.family.map_or(&CERTAIN[..], |family| &families[family]);
            for &(m, probability) in levels {
                if probability > MIN_PROBABILITY {
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
            whitening
                .blocks
                .push((block.data.clone(), BlockTransform::Factor(scored.factor)));
        }
        Ok(())
    }
}

impl Whitening {
    /// Returns the sum of the squared residuals.
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

    /// Returns W v, with one element of v for each datum; further elements are ignored.
    #[must_use]
    pub fn apply(&self, v: &[f64]) -> Vec<f64> {
        let mut whitened: Vec<f64> = self.alone.iter().map(|&(i, sd)| v[i] / sd).collect();
        for (data, transform) in &self.blocks {
            let block = data.iter().map(|&i| v[i]).collect();
            whitened.extend(match transform {
                BlockTransform::Factor(factor) => factor.whiten(block),
                BlockTransform::Shift(shift) => shift.whiten(block),
            });
        }
        whitened
    }

    /// Returns `sum_i a_i (W c)_i (W r)_i` of an applied c.
    #[must_use]
    pub fn slope(&self, c: &[f64]) -> f64 {
        let terms = c.iter().zip(&self.residuals).zip(&self.slope_weights);
        terms.map(|((x, y), weight)| x * y * weight).sum()
    }

    /// Returns `sum_i b_i (W c)_i (W d)_i` of applied c and d.
    #[must_use]
    pub fn curvature(&self, c: &[f64], d: &[f64]) -> f64 {
        let terms = c.iter().zip(d).zip(&self.curvature_weights);
        terms.map(|((x, y), weight)| x * y * weight).sum()
    }
}
