//! The projection of changes of the predictions out of those that a refit of the base would absorb.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::effect_search::class::classes;
use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::{Likelihood, Whitening};

/// The projection of changes of the predictions out of those that the fitted base absorbs.
pub(crate) struct Projection {
    whitening: Whitening,
    columns: Vec<Vec<f64>>,
    cholesky: Cholesky<f64, Dyn>,
}

/// The substitution of one effect by another that changes the predictions alike.
pub(crate) struct Exchange {
    /// Step of the new strength, in standard deviations of its prior.
    step: f64,
    /// The step of the base's parameters that absorbs the rest.
    base_step: Vec<f64>,
}

impl Exchange {
    /// Returns the position of a model, whose first parameters are the base's, after the exchange.
    ///
    /// # Arguments
    /// - `strength`: the index and the neutral value of the new strength.
    pub(crate) fn applied_to(&self, mut position: Vec<f64>, strength: (usize, f64)) -> Vec<f64> {
        for (t, by) in position.iter_mut().zip(&self.base_step) {
            *t += by;
        }
        position[strength.0] = strength.1 + self.step;
        position
    }
}

/// Returns whether two coordinates of a fit change the predictions alike, after projection out of the changes that its other coordinates
/// absorb: whether they are of one class.
pub(crate) fn are_alike(fit: &LaplaceFit, likelihood: &Likelihood, coordinates: [usize; 2]) -> bool {
    let Some(projection) = Projection::without(fit, likelihood, &coordinates) else {
        return false;
    };
    let changes = coordinates.map(|k| fit.columns[k].clone());
    classes(&projection.products(&changes), &[None, None]) == [0, 0]
}

impl Projection {
    /// Prepares the projection; `None` where the data cannot be whitened at the base's fit.
    pub(crate) fn new(base: &LaplaceFit, likelihood: &Likelihood) -> Option<Self> {
        let whitening = likelihood.whitening(&base.point.values, &base.theta()).ok()?;
        Some(Self {
            columns: base
                .columns
                .iter()
                .map(|column| whitening.apply(column))
                .collect(),
            cholesky: Cholesky::new(base.quadratic(likelihood).hessian)?,
            whitening,
        })
    }

    /// Prepares the projection out of what the coordinates of a fit absorb without some of them; `None` where the data cannot be whitened
    /// at the fit.
    ///
    /// # Arguments
    /// - `left_out`: indices of these coordinates, which rise.
    pub(crate) fn without(fit: &LaplaceFit, likelihood: &Likelihood, left_out: &[usize]) -> Option<Self> {
        let whitening = likelihood.whitening(&fit.point.values, &fit.theta()).ok()?;
        let kept = (0..fit.columns.len()).filter(|k| !left_out.contains(k));
        let hessian = fit.quadratic(likelihood).hessian;
        let hessian = hessian.remove_rows_at(left_out).remove_columns_at(left_out);
        Some(Self {
            columns: kept.map(|k| whitening.apply(&fit.columns[k])).collect(),
            cholesky: Cholesky::new(hessian)?,
            whitening,
        })
    }

    /// Returns the squared cosine of the angle between two changes after projection; 0 if one of them is absorbed.
    pub(crate) fn alignment(&self, changes: &[Vec<f64>; 2]) -> f64 {
        let products = self.products(changes);
        let lengths = products[(0, 0)] * products[(1, 1)];
        if lengths > 0.0 {
            products[(0, 1)] * products[(0, 1)] / lengths
        } else {
            0.0
        }
    }

    /// Returns whitened inner products of a change with the base's columns.
    fn along(&self, whitened: &[f64]) -> DVector<f64> {
        let products = self.columns.iter().map(|c| self.whitening.curvature(c, whitened));
        DVector::from_iterator(self.columns.len(), products)
    }

    /// Replaces a step t of the second change g by one of the first change h, of the same class: `s = t (h'P g / |h'P g|) (g'P g /
    /// h'P h)^(1/2)`, and the base moves by `(I + J'J)^-1 J'(t g - s h)`. A regression of g on h would make s too short, because
    /// both changes include numerical noise.
    pub(crate) fn exchange(&self, changes: [Vec<f64>; 2], step: f64) -> Exchange {
        let products = self.products(&changes);
        let ratio = (products[(1, 1)] / products[(0, 0)]).sqrt();
        let new_step = step * ratio.copysign(products[(0, 1)]);
        let [to, from] = changes;
        let rest: Vec<f64> = from
            .iter()
            .zip(&to)
            .map(|(g, h)| step * g - new_step * h)
            .collect();
        let along = self.along(&self.whitening.apply(&rest));
        Exchange {
            step: new_step,
            base_step: self.cholesky.solve(&along).iter().copied().collect(),
        }
    }

    /// Returns inner products of changes after projection out of `[J; I]`: `a'b - a'J (I + J'J)^-1 J'b`, whitened.
    pub(super) fn products(&self, changes: &[Vec<f64>]) -> DMatrix<f64> {
        let changes: Vec<Vec<f64>> = changes.iter().map(|g| self.whitening.apply(g)).collect();
        let along: Vec<DVector<f64>> = changes.iter().map(|g| self.along(g)).collect();
        let solved: Vec<DVector<f64>> = along.iter().map(|v| self.cholesky.solve(v)).collect();
        DMatrix::from_fn(changes.len(), changes.len(), |i, j| {
            self.whitening.curvature(&changes[i], &changes[j]) - along[i].dot(&solved[j])
        })
    }
}
