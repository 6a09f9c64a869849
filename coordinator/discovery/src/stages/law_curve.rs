//! What the data alone say of a law's curve: its knots with their covariance, for a search of its formula.

use std::ops::Range;

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::Likelihood;

/// Share of a knot's prior that is kept, so that a knot of which the data say nothing has a variance.
const KEPT: f64 = 0.04;

/// The knots of a law's curve, without the prior of the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct LawCurve {
    /// Value of each knot.
    pub knots: Vec<f64>,
    /// Covariance of the knots, row by row, with the uncertainty of all other parameters.
    pub covariance: Vec<f64>,
}

impl LawCurve {
    /// Takes the knots from a fit; `None` where the data do not determine the fit.
    ///
    /// A twenty-fifth of the curve's prior is kept, as if it were five times wider. The fit is expanded to second order.
    ///
    /// # Arguments
    /// - `parameters`: range of the knots among the parameters of the fit; their priors are normal.
    pub(super) fn new(fit: &LaplaceFit, likelihood: &Likelihood, parameters: Range<usize>) -> Option<Self> {
        let mut hessian = fit.quadratic(likelihood).hessian;
        for k in parameters.clone() {
            hessian[(k, k)] -= 1.0 - KEPT;
        }
        let covariance = hessian.cholesky()?.inverse();
        let position = &fit.point.position;
        let values = fit.theta();
        let unit = |k: usize| {
            let coordinate = &fit.frame.coordinates[k];
            coordinate.value(1.0) - coordinate.value(0.0)
        };
        let knots = parameters.clone().map(|k| {
            let pull = parameters.clone().map(|l| covariance[(k, l)] * position[l]);
            values[k] + unit(k) * (1.0 - KEPT) * pull.sum::<f64>()
        });
        let knots = knots.collect();
        let rows = parameters
            .clone()
            .flat_map(|k| parameters.clone().map(move |l| (k, l)));
        Some(Self {
            knots,
            covariance: rows
                .map(|(k, l)| unit(k) * unit(l) * covariance[(k, l)])
                .collect(),
        })
    }

    /// Returns the curve with its covariance multiplied by the misfit of the best explanation, as if the noise were larger.
    pub(super) fn with_misfit(&self, misfit: f64) -> Self {
        Self {
            knots: self.knots.clone(),
            covariance: self.covariance.iter().map(|value| value * misfit).collect(),
        }
    }
}
