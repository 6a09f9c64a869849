//! Whether a formula is the hidden one.

use std::sync::Arc;

use equation::{FittedFormula, FormulaLibrary, Host, Link, LocatedCurve, Tree, fitted};

use super::limiting_form::is_limit;

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
    pub fn is(&self, tree: &Arc<Tree>, link: Link) -> bool {
        self.exactly(tree, link).is_some()
    }

    /// Returns the formulas of a library that are the hidden one, by rising size. Formulas that are so in the limit of a constant alone are
    /// left out.
    pub fn formulas(&self, library: &FormulaLibrary, link: Link) -> Vec<Arc<Tree>> {
        let is_formula = |tree: &&Arc<Tree>| {
            let (Some(exact), Some(formula)) = (&self.exact, self.exactly(tree, link)) else {
                return false;
            };
            !is_limit(exact, &formula)
        };
        library.formulas().filter(is_formula).cloned().collect()
    }

    /// Returns a formula as it gives the exact curve; `None` if it does not, or has more constants than the law.
    fn exactly(&self, tree: &Arc<Tree>, link: Link) -> Option<FittedFormula> {
        let exact = self.exact.as_ref().filter(|_| tree.constants <= self.constants)?;
        fitted(exact, tree, link).filter(|formula| formula.misfit < MAX_MISFIT)
    }
}
