//! Classes of effects that the data cannot distinguish.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::{Likelihood, Whitening};

/// Least `|cos|` between projected changes of one class.
const ALIKE: f64 = 0.98;
/// Fits of a model that scatters differ by so much \[nats\].
const LEAST_SHORT: f64 = 3.0;

/// Evidence by which a member of a class may fall short of another that has so much, and fit as well: what the angle between them costs,
/// and no less than fits differ \[nats\].
pub(crate) fn shortfall(nats: f64) -> f64 {
    (nats * (1.0 - ALIKE * ALIKE)).max(LEAST_SHORT)
}

/// The projection of changes of the predictions out of those that the fitted base absorbs.
pub(crate) struct Projection {
    whitening: Whitening,
    columns: Vec<Vec<f64>>,
    cholesky: Cholesky<f64, Dyn>,
}

/// A change of the predictions in the place of another.
pub(crate) struct Exchange {
    /// How far it goes, in standard deviations of the strength's prior.
    pub(crate) step: f64,
    /// The step of the base's parameters that absorbs the rest.
    pub(crate) of_base: Vec<f64>,
}

impl Projection {
    /// `None` where the data cannot be whitened at the base's fit.
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

    /// How far a change moves along the columns: whitened inner products.
    fn along(&self, whitened: &[f64]) -> DVector<f64> {
        let products = self.columns.iter().map(|c| self.whitening.curvature(c, whitened));
        DVector::from_iterator(self.columns.len(), products)
    }

    /// The exchange of a step t of the second change g for one of the first h, of the same class: `s = t (h'P g / |h'P g|)
    /// (g'P g / h'P h)^(1/2)`, and of the base `(I + J'J)^-1 J'(t g - s h)`. A regression of g on h would make s too short, since
    /// changes of a model that scatters scatter, too.
    pub(crate) fn exchange(&self, changes: [Vec<f64>; 2], step: f64) -> Exchange {
        let products = self.products(&changes);
        let ratio = (products[(1, 1)] / products[(0, 0)]).sqrt();
        let own = step * ratio.copysign(products[(0, 1)]);
        let [to, from] = changes;
        let rest: Vec<f64> = from.iter().zip(&to).map(|(g, h)| step * g - own * h).collect();
        let along = self.along(&self.whitening.apply(&rest));
        Exchange {
            step: own,
            of_base: self.cholesky.solve(&along).iter().copied().collect(),
        }
    }

    /// Inner products of changes after projection out of `[J; I]`: `a'b - a'J (I + J'J)^-1 J'b`, whitened.
    pub(super) fn products(&self, changes: &[Vec<f64>]) -> DMatrix<f64> {
        let changes: Vec<Vec<f64>> = changes.iter().map(|g| self.whitening.apply(g)).collect();
        let along: Vec<DVector<f64>> = changes.iter().map(|g| self.along(g)).collect();
        let solved: Vec<DVector<f64>> = along.iter().map(|v| self.cholesky.solve(v)).collect();
        DMatrix::from_fn(changes.len(), changes.len(), |i, j| {
            self.whitening.curvature(&changes[i], &changes[j]) - along[i].dot(&solved[j])
        })
    }
}

/// Classes by complete linkage: each candidate joins the first class with `|cos| > 0.98` to every member.
///
/// # Arguments
/// - `products`: inner products of the projected changes, `[n_candidates, n_candidates]`.
///
/// # Returns
/// The class of each, from 0. A change of length zero is a class of its own.
pub(super) fn classes(products: &DMatrix<f64>) -> Vec<usize> {
    let count = products.nrows();
    let alike = |i: usize, j: usize| {
        let lengths = products[(i, i)].max(0.0) * products[(j, j)].max(0.0);
        products[(i, j)].abs() > ALIKE * lengths.sqrt()
    };
    let mut members: Vec<Vec<usize>> = Vec::new();
    let mut class = Vec::with_capacity(count);
    for i in 0..count {
        let own = members
            .iter()
            .position(|others| others.iter().all(|&j| alike(i, j)));
        class.push(own.unwrap_or(members.len()));
        match own {
            Some(k) => members[k].push(i),
            None => members.push(vec![i]),
        }
    }
    class
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_like_every_member_joins() {
        // Angles 0, 8 and 16 degrees: neighbours are alike, the ends are not; opposite signs are alike.
        let angles = [0.0_f64, 8.0, 16.0, 180.0].map(f64::to_radians);
        let products = DMatrix::from_fn(4, 4, |i, j| libm::cos(angles[i] - angles[j]) * 9.0);
        assert_eq!(classes(&products), [0, 0, 1, 0]);
    }

    #[test]
    fn what_changes_nothing_is_a_class_of_its_own() {
        assert_eq!(classes(&DMatrix::zeros(2, 2)), [0, 1]);
    }
}
