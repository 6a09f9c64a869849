//! Fit the most probable extensions again with Jacobians of their own.

use crate::descent::{Descent, Step};

/// A fresh Jacobian, and what steps it shows; the evidence is read from the last.
pub(crate) const PLAN: [Step; 2] = [Step::Differences, Step::Trials(6)];

/// The same again, as long as steps gain.
pub(crate) const TWICE: [Step; 1] = [Step::Rounds { most: 3, trials: 8 }];

/// The same fit, gone on with.
pub(crate) fn descent(fitted: &Descent, plan: &[Step]) -> Descent {
    Descent::new(
        fitted.frame.clone(),
        fitted.point.clone(),
        fitted.columns.clone(),
        plan,
    )
}
