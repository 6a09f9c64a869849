//! Score test for a trend of the residuals with a regressor, after the part that the fit absorbs.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::predicted_draw::PredictedDraw;
use super::residual::separate_noise_sd;
use super::spectrum::mean_and_covariance;
use statistics::likelihood::{ErrorLaw, Likelihood, LikelihoodError, Whitening};
use statistics::prior::Prior;

/// If the fit absorbs all but this share of a regressor, the rest is an error of the linear model.
const MIN_SHARE: f64 = 0.02;

/// The slope of the residuals along a regressor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trend {
    /// Measured minus predicted for one unit of the regressor, corrected for the part that the fit absorbs [unit of the data].
    pub slope: f64,
    /// Standard deviation of the slope where there is no trend.
    pub sd: f64,
    /// Share of the regressor that the fit cannot absorb, in (0, 1].
    pub share_left: f64,
    /// The slope over its standard deviation; where the noise is inferred, the latter is estimated from the residuals.
    pub statistic: f64,
    /// Two-sided probability of a statistic this large.
    pub p: f64,
}

/// The posterior as a linear model with normal parameters, to test any number of regressors.
///
/// # Equation
/// With the parameters as independent standard normal scores u, predictions are `f + X (u - m)`, m the posterior mean of u and X
/// the regression of the predictions on u over the draws. A regressor x, added with an unknown factor, has the efficient score
/// and information `U = x' R^-1 r - a' (X' R^-1 r - m)`, `I = x' R^-1 x - a' X' R^-1 x`, `a = (1 + X' R^-1 X)^-1 X' R^-1 x`, with
/// r the residuals and R the covariance of the errors. `slope = U / I`, `sd = 1 / sqrt(I)`, and `U / sqrt(I)` is standard normal
/// where nothing is missing: `I = x' C^-1 x`, C the prior predictive covariance of the data. Where the noise sd of all data of a
/// regressor is inferred, it is re-estimated from the residuals without the trend, and the statistic is Student's.
///
/// # Validity
/// Exact for predictions that are linear in normal scores and normal errors of known covariance (or one unknown sd, under a weak
/// prior); under Student's errors asymptotic. A small distance of the posterior mean from the mode has no effect at first order.
///
/// # Source
/// Cox & Hinkley 1974, *Theoretical Statistics*, section 9.3 (score test with nuisance parameters); Neyman 1959 (C(alpha)).
/// Checked by `trends::a_trend_of_a_line_is_its_closed_form`, `trends::trends_keep_their_level` and
/// `trends::a_real_trend_is_found`.
#[derive(Debug)]
pub struct TrendTest<'a> {
    likelihood: &'a Likelihood,
    whitening: Whitening,
    /// Measured minus predicted.
    residuals: Vec<f64>,
    /// Sensitivities of the predictions, the columns of X.
    sensitivities: Vec<Vec<f64>>,
    /// Columns of X, whitened.
    whitened: Vec<Vec<f64>>,
    /// `X' R^-1 r - m`: 0 at the mode.
    gradient: DVector<f64>,
    /// `1 + X' R^-1 X`.
    precision: Cholesky<f64, Dyn>,
    /// Standard deviation of each datum's error, and its row of `X` over it, scaled so that products of rows are the
    /// elements of the hat matrix.
    rows: Vec<(f64, DVector<f64>)>,
}

impl<'a> TrendTest<'a> {
    /// Prepares the test; `None` for fewer than two draws, or draws that do not spread in every direction.
    ///
    /// # Arguments
    /// - `prior`: the prior of all parameters, in the order of theta.
    /// - `draws`: equally weighted draws of the posterior with their predictions.
    ///
    /// # Errors
    /// The errors of [`Likelihood::log_likelihood`].
    pub fn new(
        likelihood: &'a Likelihood,
        prior: &Prior,
        draws: &[PredictedDraw],
    ) -> Result<Option<Self>, LikelihoodError> {
        let Some(mean) = PredictedDraw::mean(draws) else {
            return Ok(None);
        };
        let scores: Vec<Vec<f64>> = draws.iter().map(|draw| scores(prior, &draw.theta)).collect();
        let Some((centre, sensitivities)) = sensitivities(&scores, draws, &mean) else {
            return Ok(None);
        };
        let variances = likelihood.error_variances(&mean.values, &mean.theta)?;
        let whitening = likelihood.whitening(&mean.values, &mean.theta)?;
        let whitened: Vec<Vec<f64>> = sensitivities.iter().map(|x| whitening.apply(x)).collect();
        let count = whitened.len();
        let information = DMatrix::from_fn(count, count, |j, k| {
            whitening.curvature(&whitened[j], &whitened[k])
        });
        let Some(precision) = Cholesky::new(DMatrix::identity(count, count) + information) else {
            return Ok(None);
        };
        let gradient = DVector::from_fn(count, |k, _| whitening.slope(&whitened[k]) - centre[k]);
        let data = likelihood.data();
        let rows = (0..data.len()).map(|i| {
            let sd = variances[i].sqrt();
            let row = DVector::from_iterator(count, sensitivities.iter().map(|x| x[i] / sd));
            // A triangle with a positive diagonal always has an inverse.
            let solved = precision.l_dirty().solve_lower_triangular(&row);
            (sd, solved.unwrap_or(row))
        });
        Ok(Some(TrendTest {
            likelihood,
            residuals: data.iter().zip(&mean.values).map(|(d, m)| d.value - m).collect(),
            rows: rows.collect(),
            whitening,
            sensitivities,
            whitened,
            gradient,
            precision,
        }))
    }

    /// Returns the trend of the residuals with a regressor; `None` where the fit absorbs all of it, or no residuals are left to
    /// estimate the noise from.
    ///
    /// # Arguments
    /// - `regressor`: one value for each datum, 0 for data that it does not affect.
    #[must_use]
    pub fn against(&self, regressor: &[f64]) -> Option<Trend> {
        let x = self.whitening.apply(regressor);
        let whole = self.whitening.curvature(&x, &x);
        let overlap = DVector::from_iterator(
            self.whitened.len(),
            self.whitened.iter().map(|w| self.whitening.curvature(w, &x)),
        );
        let absorbed = self.precision.solve(&overlap);
        let information = whole - absorbed.dot(&overlap);
        let share_left = information / whole;
        // The share is NaN where the regressor is 0.
        if share_left.is_nan() || share_left < MIN_SHARE {
            return None;
        }
        let slope = (self.whitening.slope(&x) - absorbed.dot(&self.gradient)) / information;
        let sd = 1.0 / information.sqrt();
        let (statistic, law) = match self.scale_of(regressor) {
            None => (slope / sd, ErrorLaw::Gaussian),
            Some(parameter) => {
                let left = self.left_of(regressor, &absorbed);
                let (scale, degrees_of_freedom) = self.scale(parameter, slope, sd, &left)?;
                (slope / (sd * scale), ErrorLaw::StudentT { degrees_of_freedom })
            }
        };
        Some(Trend {
            slope,
            sd,
            share_left,
            statistic,
            p: 2.0 * law.cumulative(-statistic.abs()),
        })
    }

    /// Returns the parameter that is the noise sd of all data that the regressor affects.
    fn scale_of(&self, regressor: &[f64]) -> Option<usize> {
        let concerned = (0..regressor.len()).filter(|&i| regressor[i].abs() > 0.0);
        let mut scales = concerned.map(|i| separate_noise_sd(self.likelihood, i));
        let first = scales.next()??;
        scales.all(|scale| scale == Some(first)).then_some(first)
    }

    /// Returns the residual of a regressor after the fit.
    fn left_of(&self, regressor: &[f64], absorbed: &DVector<f64>) -> Vec<f64> {
        let mut left = regressor.to_vec();
        for (column, share) in self.sensitivities.iter().zip(absorbed.iter()) {
            for (value, x) in left.iter_mut().zip(column) {
                *value -= share * x;
            }
        }
        left
    }

    /// Returns the noise sd of the residuals without the trend over the posterior's, and its degrees of freedom: those of the
    /// chi-square with the mean and variance of their sum of squares (Satterthwaite).
    fn scale(&self, parameter: usize, slope: f64, sd: f64, left: &[f64]) -> Option<(f64, f64)> {
        let peers: Vec<usize> = (0..self.rows.len())
            .filter(|&i| separate_noise_sd(self.likelihood, i) == Some(parameter))
            .collect();
        let in_sds = |i: usize, value: f64| value / self.rows[i].0;
        // Share of the error i that remains in the residual j.
        let left_of_error = |i: usize, j: usize| {
            let by_fit = self.rows[i].1.dot(&self.rows[j].1);
            let by_trend = sd * sd * in_sds(i, left[i]) * in_sds(j, left[j]);
            f64::from(u8::from(i == j)) - by_fit - by_trend
        };
        let (mut squares, mut expected, mut half_variance) = (0.0, 0.0, 0.0);
        for &i in &peers {
            squares += in_sds(i, self.residuals[i] - slope * left[i]).powi(2);
            expected += left_of_error(i, i);
            half_variance += peers.iter().map(|&j| left_of_error(i, j).powi(2)).sum::<f64>();
        }
        let degrees_of_freedom = expected * expected / half_variance;
        let is_known = squares > 0.0 && expected > 0.0 && degrees_of_freedom >= 1.0;
        is_known.then(|| ((squares / expected).sqrt(), degrees_of_freedom))
    }
}

/// Returns parameters as independent standard normal numbers.
fn scores(prior: &Prior, theta: &[f64]) -> Vec<f64> {
    let marginals = prior.marginals().iter().zip(theta);
    let mut scores: Vec<f64> = marginals.map(|(marginal, &x)| marginal.normal_score(x)).collect();
    prior.make_independent(&mut scores);
    scores
}

/// Returns the mean scores of the draws and the regression of the predictions on them, a column for each score.
fn sensitivities(
    scores: &[Vec<f64>],
    draws: &[PredictedDraw],
    mean: &PredictedDraw,
) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    let (centre, covariance) = mean_and_covariance(scores)?;
    let covariance = Cholesky::new(covariance)?;
    let count = centre.len();
    let mut columns = vec![vec![0.0; mean.values.len()]; count];
    for i in 0..mean.values.len() {
        let shared = DVector::from_fn(count, |k, _| {
            let cross = scores.iter().zip(draws);
            let cross = cross.map(|(u, draw)| (u[k] - centre[k]) * (draw.values[i] - mean.values[i]));
            cross.sum::<f64>() / (draws.len() - 1) as f64
        });
        let slopes = covariance.solve(&shared);
        for (column, slope) in columns.iter_mut().zip(slopes.iter()) {
            column[i] = *slope;
        }
    }
    Some((centre, columns))
}
