//! Whether a formula is the hidden one.

use std::sync::Arc;

use equation::{Host, Link, LocatedCurve, Tree, fitted};

/// Points of the exact curve.
const POINTS: usize = 40;
/// Sd of the exact curve over its root mean square.
const SHARP: f64 = 1e-4;
/// Half the squares of the residuals up to which a formula gives the exact curve.
const MAX_MISFIT: f64 = 5.0;

/// A hidden law without noise.
#[derive(Debug)]
pub struct Truth {
    /// `None` if the law has no curve in the range.
    exact: Option<LocatedCurve>,
    /// Constants of the law, beside its factor.
    constants: usize,
}

impl Truth {
    pub fn new(law: impl Fn(f64) -> f64, [low, high]: [f64; 2], constants: usize) -> Self {
        let share = |i: usize| (i as f64 + 0.5) / POINTS as f64;
        let points: Vec<f64> = (0..POINTS).map(|i| low + (high - low) * share(i)).collect();
        let values: Vec<f64> = points.iter().map(|x| law(*x)).collect();
        let square = values.iter().map(|y| y * y).sum::<f64>() / POINTS as f64;
        let variance = SHARP * SHARP * square;
        let covariance = (0..POINTS * POINTS).map(|i| if i % (POINTS + 1) == 0 { variance } else { 0.0 });
        let covariance: Vec<f64> = covariance.collect();
        Self {
            exact: LocatedCurve::new(Host::Addition, &points, &values, &covariance).ok(),
            constants,
        }
    }

    /// Returns whether a formula gives the exact curve with no more constants than the law has.
    pub fn is(&self, tree: &Arc<Tree>) -> bool {
        let fit = |exact: &LocatedCurve| fitted(exact, tree, Link::Proportional);
        let misfit = self.exact.as_ref().and_then(fit).map(|fit| fit.misfit);
        tree.constants <= self.constants && misfit.is_some_and(|misfit| misfit < MAX_MISFIT)
    }
}
