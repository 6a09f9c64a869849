//! An engine that goes on from a set of effects, its candidates named by their positions among all.

use super::asked::{Asked, Model};
use crate::engine::Engine;
use crate::finding::Judged;

/// A search beyond a set of effects, or a fit of the base without one of its own.
#[derive(Debug, Clone)]
pub(super) struct Search {
    /// The effects that the model has, beyond the base.
    pub(super) set: Vec<usize>,
    /// Which effect of the base's own it lacks.
    pub(super) reduction: Option<usize>,
    /// The position of each of the engine's candidates.
    pub(super) candidates: Vec<usize>,
    pub(super) engine: Engine,
}

impl Search {
    pub(super) fn new(set: Vec<usize>, candidates: Vec<usize>, engine: Engine) -> Self {
        Self {
            set,
            reduction: None,
            candidates,
            engine,
        }
    }

    /// The fit of the base without one of its effects.
    pub(super) fn without(reduction: usize, engine: Engine) -> Self {
        Self {
            reduction: Some(reduction),
            ..Self::new(Vec::new(), Vec::new(), engine)
        }
    }

    /// What the engine asks for; nothing once it is done.
    pub(super) fn wanted(&self) -> Vec<Asked> {
        if self.engine.finding().is_some() || self.engine.failure().is_some() {
            return Vec::new();
        }
        let asked = self.engine.pending().map(|request| {
            let mut effects = self.set.clone();
            effects.extend(request.candidate.map(|k| self.candidates[k]));
            Asked {
                model: self.reduction.map_or(Model::With(effects), Model::Without),
                is_proposed: false,
                theta: request.theta,
            }
        });
        asked.collect()
    }

    /// Tells the engine all answers of its round.
    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        for (index, values) in answers.into_iter().enumerate() {
            // The values were checked when they came in, and each index is told once.
            let told = self.engine.tell(index, values.as_deref());
            debug_assert!(told.is_ok(), "{told:?}");
        }
    }

    /// The candidates that were judged, by falling Bayes factor, with their positions.
    pub(super) fn ranked(&self) -> Vec<(usize, &Judged)> {
        let finding = self.engine.finding().into_iter();
        let judged = finding.flat_map(|finding| finding.ranked());
        judged
            .filter_map(|judged| Some((self.candidates[judged.candidate?], judged)))
            .collect()
    }
}
