//! The task and the results of a search.

use crate::search::hypotheses::Hypotheses;
use crate::task::SearchTask;

/// The task, the results so far, and their cost.
#[derive(Debug, Clone)]
pub(super) struct SearchState {
    pub(super) task: SearchTask,
    pub(super) hypotheses: Hypotheses,
    pub(super) evaluations: usize,
}
