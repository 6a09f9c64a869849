//! The Laplace approximation at the result of a fit.

use nalgebra::{Cholesky, DMatrix};

use super::objective::{Column, FitPoint, Objective};
use crate::point_estimate::{Laplace, ModeEstimate, StopReason};

impl Objective {
    /// Returns the estimate at a point; evaluations are counted by the caller.
    pub(super) fn estimate(&self, point: &FitPoint, columns: &[Column], stop: StopReason) -> ModeEstimate {
        let dimension = self.prior.dimension();
        let mut at_bound = vec![false; dimension];
        let mut covariance = vec![vec![0.0; dimension]; dimension];
        let mut sd = vec![None; dimension];
        for (axis, &t) in self.axes.iter().zip(&point.position) {
            at_bound[axis.parameter] = axis.is_bound(t);
        }
        for (k, profiled) in self.noises.parameters().into_iter().zip(&point.noise) {
            at_bound[k] = profiled.at_bound;
            sd[k] = profiled.uncertainty;
            covariance[k][k] = profiled.uncertainty.map_or(0.0, |sd| sd * sd);
        }
        let hessian = self.quadratic(point, columns).hessian;
        let free: Vec<usize> = (0..self.axes.len())
            .filter(|&k| {
                let has_column = columns.get(k).is_some_and(Option::is_some);
                has_column && !at_bound[self.axes[k].parameter] && hessian[(k, k)] > 0.0
            })
            .collect();
        let curvature = DMatrix::from_fn(free.len(), free.len(), |i, j| hessian[(free[i], free[j])]);
        if let Some(cholesky) = Cholesky::new(curvature) {
            let inverse = cholesky.inverse();
            let rate = |i: usize| self.axes[free[i]].rate(point.position[free[i]]);
            let parameter = |i: usize| self.axes[free[i]].parameter;
            for i in 0..free.len() {
                for j in 0..free.len() {
                    covariance[parameter(i)][parameter(j)] = rate(i) * inverse[(i, j)] * rate(j);
                }
                sd[parameter(i)] = Some(rate(i) * inverse[(i, i)].sqrt());
            }
        }
        ModeEstimate {
            theta: point.theta.clone(),
            log_likelihood: point.log_likelihood,
            log_prior: point.log_prior,
            at_bound,
            laplace: Some(Laplace { sd, covariance }),
            approximation: None,
            evaluations: 0,
            rejected: 0,
            stop,
            history: Vec::new(),
        }
    }
}
