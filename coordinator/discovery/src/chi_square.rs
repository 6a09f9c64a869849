//! The goodness of a fit: its chi-square with the effective degrees of freedom, and the thresholds of its p-value.

use crate::laplace::fit::LaplaceFit;
use inference::diagnostics::chi_square_tail;
use statistics::likelihood::{CommonError, CommonErrorSize, ErrorLaw, ErrorSd, Likelihood};

/// p-value below which a fit contradicts the data.
const WRONG: f64 = 0.001;
/// p-value below which a fit leaves something unexplained.
const INCOMPLETE: f64 = 0.01;
/// p-value of the library's best fit below which one more effect is searched.
pub(crate) const FURTHER_EFFECT: f64 = 0.5;
/// p-value of the base's fit below which laws outside the library are searched although no effect is detected.
pub(crate) const OUTSIDE_LAW: f64 = 0.05;

/// Squared residuals in units of the noise, and their degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitChiSquare {
    /// Sum of the squared residuals.
    pub value: f64,
    /// Number of data minus the effective number of fitted parameters.
    pub degrees_of_freedom: f64,
}

impl FitChiSquare {
    /// Computes the chi-square of a fit; `None` with inferred noise, heavy tails or a model discrepancy.
    pub(crate) fn of_fit(fit: &LaplaceFit, likelihood: &Likelihood) -> Option<Self> {
        let is_inferred = |sd: ErrorSd| sd.parameter().is_some();
        // The size of a discrepancy is unknown, so it has no sd.
        let is_unknown =
            |error: &CommonError| error.size.sd().is_none() || error.size.hyperparameters().any(is_inferred);
        let is_known = likelihood.law() == ErrorLaw::Gaussian
            && !likelihood.data().iter().any(|datum| is_inferred(datum.sd))
            && !likelihood.common().iter().any(is_unknown);
        if !is_known {
            return None;
        }
        let theta = fit.theta();
        let whitening = likelihood.whitening(&fit.point.values, &theta).ok()?;
        // The effective number of parameters is 1 - posterior variance over prior variance, summed.
        let uncertainty = fit.quadratic(likelihood).uncertainty();
        let fitted: f64 = uncertainty.iter().flatten().map(|sd| 1.0 - sd * sd).sum();
        Some(Self {
            value: whitening.squared_residuals(),
            degrees_of_freedom: likelihood.data().len() as f64 - fitted,
        })
    }

    /// Computes the chi-square of a fit; with a model discrepancy, by the declared noise alone. Histories, whose errors are all
    /// inferred, are left out then.
    pub(crate) fn of_declared_noise(fit: &LaplaceFit, likelihood: &Likelihood) -> Option<Self> {
        Self::of_fit(fit, likelihood).or_else(|| {
            let data = likelihood.data();
            let of_history = |i: &usize| {
                let mut errors = likelihood.common().iter();
                errors.any(|error| {
                    matches!(error.size, CommonErrorSize::Innovation(_)) && error.data.contains(i)
                })
            };
            let kept: Vec<usize> = (0..data.len()).filter(|i| !of_history(i)).collect();
            let declared = Likelihood::new(kept.iter().map(|&i| data[i]).collect()).ok()?;
            let derivatives = likelihood.values() - data.len();
            if derivatives > 0 || likelihood.law() != ErrorLaw::Gaussian {
                return None;
            }
            match kept.len() == data.len() {
                true => Self::of_fit(fit, &declared),
                false => Self::of_fit(&of_values(fit, &kept), &declared),
            }
        })
    }

    /// Returns the p-value of the fit.
    #[must_use]
    pub fn p(&self) -> f64 {
        chi_square_tail(self.value, self.degrees_of_freedom).unwrap_or(1.0)
    }

    /// Returns whether the fit contradicts the data: p < 0.001.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.p() < WRONG
    }

    /// Returns whether the fit leaves nothing to explain: p >= 0.01.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.p() >= INCOMPLETE
    }

    /// Returns the chi-square over its degrees of freedom, at least 1.
    pub(crate) fn ratio(&self) -> f64 {
        (self.value / self.degrees_of_freedom.max(1.0)).max(1.0)
    }

    /// Returns the chi-square less its degrees of freedom.
    pub(crate) fn excess(&self) -> f64 {
        self.value - self.degrees_of_freedom
    }
}

/// Returns the measured less the predicted value of each datum, in declared noise sds; 0 where the sd is inferred.
pub(crate) fn residuals(fit: &LaplaceFit, likelihood: &Likelihood) -> Vec<f64> {
    let pairs = likelihood.data().iter().zip(&fit.point.values);
    pairs
        .map(|(datum, value)| match datum.sd {
            ErrorSd::Known(sd) => (datum.value - value) / sd,
            ErrorSd::Inferred { .. } => 0.0,
        })
        .collect()
}

/// Returns a fit with some of its predicted values.
fn of_values(fit: &LaplaceFit, kept: &[usize]) -> LaplaceFit {
    let select = |values: &[f64]| kept.iter().map(|&i| values[i]).collect();
    let mut part = fit.clone();
    part.point.values = select(&fit.point.values);
    part.columns = fit.columns.iter().map(|column| select(column)).collect();
    part
}
