//! A fit with the likelihood that scores it.

use crate::laplace::fit::LaplaceFit;
use crate::task::SearchTask;
use statistics::likelihood::Likelihood;

/// A fit with the likelihood that scores it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScoredFit<'a> {
    pub(super) fit: &'a LaplaceFit,
    /// The likelihood, which reads inferred sds from the parameters of the fit by their positions. These are other positions where the
    /// model lacks an effect of the base.
    pub(super) likelihood: &'a Likelihood,
}

impl<'a> ScoredFit<'a> {
    /// Returns a fit of the base, or of the base with candidates, with the likelihood of the task.
    pub(super) fn new(task: &'a SearchTask, fit: &'a LaplaceFit) -> Self {
        Self {
            fit,
            likelihood: &task.likelihood,
        }
    }
}
