//! Fit the most probable extensions again with Jacobians of their own.

use super::descent::{Descent, Step};

/// How many extensions are polished.
pub(super) const COUNT: usize = 3;

/// A fresh Jacobian, and what steps it shows; the evidence is read from the last.
const PLAN: [Step; 2] = [Step::Differences, Step::Trials(6)];

/// The same fit, gone on with.
pub(super) fn descent(fitted: &Descent) -> Descent {
    Descent::new(
        fitted.frame.clone(),
        fitted.point.clone(),
        fitted.columns.clone(),
        &PLAN,
    )
}
