//! A fit by damped least squares with independent normal priors.

use nalgebra::{DMatrix, DVector};

/// The step of a difference, over the scale of a coordinate.
const STEP: f64 = 1e-4;
const FIRST_DAMPING: f64 = 1e-2;
const MAX_DAMPING: f64 = 1e8;
/// A fit ends where a step gains less.
const LEAST_GAIN: f64 = 1e-4;

/// A coordinate of a fit: the normal prior of a parameter. An infinite sd is no prior.
#[derive(Debug, Clone, Copy)]
pub struct Coordinate {
    pub mean: f64,
    pub sd: f64,
    /// A length over which the residuals change.
    pub scale: f64,
}

/// The end of a fit.
#[derive(Debug, Clone)]
pub struct LeastSquares {
    pub place: Vec<f64>,
    /// Half the squares of the residuals and of the coordinates over their prior sds.
    pub objective: f64,
    /// Half the squares of the residuals.
    pub misfit: f64,
    /// The Gauss–Newton matrix.
    pub hessian: DMatrix<f64>,
}

impl LeastSquares {
    /// Returns the log evidence by Laplace's approximation, without the part of the measurements' errors that all models share; `None` if
    /// the matrix is not positive definite.
    ///
    /// # Arguments
    /// - `coordinates`: those of the fit; each has a finite sd.
    pub fn log_evidence(&self, coordinates: &[Coordinate]) -> Option<f64> {
        let root = self.hessian.clone().cholesky()?;
        let volume: f64 = coordinates
            .iter()
            .enumerate()
            .map(|(k, c)| libm::log(c.sd * root.l()[(k, k)]))
            .sum();
        Some(-self.objective - volume)
    }
}

/// Residuals and their derivatives at a place.
struct Slope {
    objective: f64,
    misfit: f64,
    gradient: DVector<f64>,
    hessian: DMatrix<f64>,
}

/// Fits by damped Gauss–Newton steps (Levenberg 1944, Marquardt 1963); `None` if the start has no finite residuals.
pub fn fit(
    coordinates: &[Coordinate],
    start: Vec<f64>,
    steps: usize,
    residuals: impl Fn(&[f64]) -> Option<Vec<f64>>,
) -> Option<LeastSquares> {
    let penalty = |place: &[f64]| -> f64 {
        let pairs = place.iter().zip(coordinates);
        let square = |(x, c): (&f64, &Coordinate)| ((x - c.mean) / c.sd) * ((x - c.mean) / c.sd);
        0.5 * pairs.map(square).sum::<f64>()
    };
    let misfit = |values: &[f64]| 0.5 * values.iter().map(|r| r * r).sum::<f64>();
    let objective = |place: &[f64]| residuals(place).map(|values| misfit(&values) + penalty(place));
    let slope = |place: &[f64]| -> Option<Slope> {
        let here = residuals(place)?;
        let columns: Vec<Vec<f64>> = (0..place.len())
            .map(|k| {
                let mut moved = place.to_vec();
                moved[k] += STEP * coordinates[k].scale;
                let there = residuals(&moved)?;
                let pairs = there.iter().zip(&here);
                Some(
                    pairs
                        .map(|(a, b)| (a - b) / (STEP * coordinates[k].scale))
                        .collect(),
                )
            })
            .collect::<Option<_>>()?;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let weight = |k: usize| 1.0 / (coordinates[k].sd * coordinates[k].sd);
        let gradient = DVector::from_fn(place.len(), |k, _| {
            dot(&columns[k], &here) + (place[k] - coordinates[k].mean) * weight(k)
        });
        let hessian = DMatrix::from_fn(place.len(), place.len(), |j, k| {
            dot(&columns[j], &columns[k]) + if j == k { weight(k) } else { 0.0 }
        });
        let is_finite = gradient.iter().chain(hessian.iter()).all(|x| x.is_finite());
        is_finite.then(|| Slope {
            objective: misfit(&here) + penalty(place),
            misfit: misfit(&here),
            gradient,
            hessian,
        })
    };
    let mut place = start;
    let mut at = slope(&place)?;
    let mut damping = FIRST_DAMPING;
    for _ in 0..steps {
        let mut damped = at.hessian.clone();
        for k in 0..place.len() {
            damped[(k, k)] += damping * damped[(k, k)].max(1e-12);
        }
        let Some(step) = damped.cholesky().map(|root| root.solve(&at.gradient)) else {
            damping *= 10.0;
            if damping > MAX_DAMPING {
                break;
            }
            continue;
        };
        let next: Vec<f64> = place.iter().zip(step.iter()).map(|(x, by)| x - by).collect();
        let gain = objective(&next).map_or(f64::NAN, |reached| at.objective - reached);
        let reached = if gain > 0.0 { slope(&next) } else { None };
        match reached {
            Some(reached) => {
                (place, at) = (next, reached);
                damping = (damping * 0.1).max(1e-10);
                if gain < LEAST_GAIN {
                    break;
                }
            }
            None if damping > MAX_DAMPING => break,
            None => damping = (10.0 * damping).max(FIRST_DAMPING),
        }
    }
    Some(LeastSquares {
        place,
        objective: at.objective,
        misfit: at.misfit,
        hessian: at.hessian,
    })
}
