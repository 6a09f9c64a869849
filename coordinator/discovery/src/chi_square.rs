//! How well a fit does.

use crate::descent::Descent;
use inference::diagnostics::chi_square_tail;
use statistics::likelihood::{CommonErrorSize, Discrepancy, ErrorLaw, ErrorSd, Likelihood};

/// A fit with less chance than this is wrong.
pub(crate) const WRONG: f64 = 0.001;

/// Squared residuals in units of the noise, against the data less what the fit used up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChiSquare {
    /// Their sum.
    pub value: f64,
    /// Number of data less the effective number of fitted parameters.
    pub degrees_of_freedom: f64,
}

impl ChiSquare {
    /// Of a fit; `None` where the noise was inferred from the misfit, has heavy tails, or the model may miss by a discrepancy.
    pub(crate) fn of(fit: &Descent, likelihood: &Likelihood) -> Option<Self> {
        let unknown = |sd: ErrorSd| matches!(sd, ErrorSd::Inferred { .. });
        let is_known = likelihood.law() == ErrorLaw::Gaussian
            && likelihood.discrepancy() == Discrepancy::None
            && !likelihood.data().iter().any(|d| unknown(d.sd))
            && !likelihood.common().iter().any(|error| match error.size {
                CommonErrorSize::Shift(sd) | CommonErrorSize::Sensitivity(sd) => unknown(sd),
                CommonErrorSize::Discrepancy => true,
            });
        if !is_known {
            return None;
        }
        let theta = fit.frame.theta(&fit.point.position);
        let whitening = likelihood.whitening(&fit.point.values, &theta).ok()?;
        // The prior holds back a parameter as far as its sd stays what it was: a share of 1 - variance is fitted.
        let uncertainty = fit.parabola(likelihood).uncertainty();
        let fitted: f64 = uncertainty.iter().flatten().map(|sd| 1.0 - sd * sd).sum();
        Some(Self {
            value: whitening.squared_residuals(),
            degrees_of_freedom: likelihood.data().len() as f64 - fitted,
        })
    }

    /// The probability of as much by chance.
    #[must_use]
    pub fn p(&self) -> f64 {
        chi_square_tail(self.value, self.degrees_of_freedom).unwrap_or(1.0)
    }
}
