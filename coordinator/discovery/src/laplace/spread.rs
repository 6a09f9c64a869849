//! Points one standard deviation from the mode, which give the uncertainty of a fit's predictions.

use nalgebra::Cholesky;

use crate::laplace::fit::LaplaceFit;
use crate::settings::Smoothness;
use statistics::likelihood::Likelihood;

/// Parameter vectors one standard deviation to either side of a fit's mode, along a column of the factor L of the posterior
/// covariance L L' by Laplace's approximation.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    /// The vectors to evaluate, `None` beyond the limits. A rough model, whose evaluations are expensive, is evaluated on one
    /// side only.
    pub(crate) sides: [Option<Vec<f64>>; 2],
    /// The vector to evaluate if the model rejects these.
    pub(crate) spare: Option<Vec<f64>>,
}

impl Axis {
    /// Returns this axis with one side to evaluate and the other in reserve.
    pub(crate) fn one_sided(self) -> Self {
        let [above, below] = self.sides;
        match above {
            Some(_) => Self {
                sides: [above, None],
                spare: below,
            },
            None => Self {
                sides: [None, below],
                spare: None,
            },
        }
    }
}

/// Returns the axes about a fit's mode; none where the posterior has no covariance.
pub(crate) fn spread(fit: &LaplaceFit, likelihood: &Likelihood) -> Vec<Axis> {
    let covariance = Cholesky::new(fit.quadratic(likelihood).hessian).map(|c| c.inverse());
    let Some(factor) = covariance.and_then(Cholesky::new).map(|c| c.l()) else {
        return Vec::new();
    };
    let mode = &fit.point.position;
    let theta = |column: usize, side: f64| {
        let position = mode
            .iter()
            .enumerate()
            .map(|(k, t)| t + side * factor[(k, column)]);
        let position: Vec<f64> = position.collect();
        fit.frame.holds(&position).then(|| fit.frame.theta(&position))
    };
    (0..mode.len())
        .map(|column| {
            let (above, below) = (theta(column, 1.0), theta(column, -1.0));
            let is_expensive = fit.frame.smoothness != Smoothness::Smooth && !fit.frame.has_low_fidelity;
            if above.is_some() && is_expensive {
                Axis {
                    sides: [above, None],
                    spare: below,
                }
            } else {
                Axis {
                    sides: [above, below],
                    spare: None,
                }
            }
        })
        .collect()
}
