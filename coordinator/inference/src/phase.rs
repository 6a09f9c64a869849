//! The state of an ask/tell algorithm beside its round: its progress and its evaluations.

use crate::tell::{InferenceFailure, TellProgress};

/// The phase of an algorithm, or its end.
#[derive(Debug, Clone)]
pub(crate) enum RunPhase<W, R> {
    Waiting(W),
    Done(Box<R>),
    Failed(InferenceFailure),
}

impl<W, R> RunPhase<W, R> {
    pub(crate) fn result(&self) -> Option<&R> {
        match self {
            Self::Done(result) => Some(result),
            Self::Waiting(_) | Self::Failed(_) => None,
        }
    }

    pub(crate) fn failure(&self) -> Option<InferenceFailure> {
        match self {
            Self::Failed(failure) => Some(*failure),
            Self::Waiting(_) | Self::Done(_) => None,
        }
    }

    /// Returns the progress after a told result; `complete`: it was the last one of its round.
    pub(crate) fn progress(&self, complete: bool) -> TellProgress {
        match self {
            Self::Done(_) => TellProgress::Finished,
            Self::Failed(failure) => TellProgress::Failed(*failure),
            Self::Waiting(_) if complete => TellProgress::NextRound,
            Self::Waiting(_) => TellProgress::Waiting,
        }
    }
}

/// Evaluations in completed rounds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EvaluationCount {
    /// Number of all evaluations.
    pub evaluations: usize,
    /// Number of evaluations that the model rejected.
    pub rejected: usize,
}

impl EvaluationCount {
    /// Counts evaluations, each with whether the model rejected it.
    pub(crate) fn add(&mut self, rejections: impl Iterator<Item = bool>) {
        for is_rejected in rejections {
            self.evaluations += 1;
            self.rejected += usize::from(is_rejected);
        }
    }
}
