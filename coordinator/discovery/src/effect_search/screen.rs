//! Phase 2, the screen: each candidate is evaluated at a few strengths and shapes about the base's fit.

use crate::effect_search::screened::{Evaluated, LEVELS, positions, screened};
use crate::effect_search::state::{EffectSearch, Phase};
use crate::laplace::batch::PositionRequest;

impl EffectSearch {
    /// Evaluates candidates at the strengths of a level.
    pub(super) fn screen(&mut self, level: usize, candidates: Vec<usize>) {
        let Some(base) = &self.base else { return };
        let mut requests = Vec::new();
        for &k in &candidates {
            let frame = &self.candidates[k].frame;
            let base = &base.fit.point.position;
            let positions = positions(frame, base, &self.depth.screen, self.best_shape(k), level);
            requests.extend(PositionRequest::all_for_model(Some(k), positions));
        }
        if requests.is_empty() && level + 1 < LEVELS.len() {
            return self.screen(level + 1, candidates);
        }
        if requests.is_empty() {
            return self.begin_extensions();
        }
        self.ask(requests);
        self.phase = Phase::Screen(level);
    }

    /// Keeps the results of a level; candidates that the model refused at it are screened at the next.
    pub(super) fn take_screen(&mut self, level: usize, answers: Vec<Option<Vec<f64>>>) {
        let Some(base) = &self.base else { return };
        self.evaluations.screen += answers.len();
        let mut evaluated: Vec<Vec<Evaluated>> = vec![Vec::new(); self.candidates.len()];
        for (request, values) in std::mem::take(&mut self.requests).into_iter().zip(answers) {
            if let Some(k) = request.candidate {
                evaluated[k].push((request.position, values));
            }
        }
        let mut refused = Vec::new();
        for (k, (state, evaluated)) in self.candidates.iter_mut().zip(evaluated).enumerate() {
            if evaluated.is_empty() {
                continue;
            }
            let screened = screened(&state.frame, base, &self.likelihood, &evaluated);
            state.take_screened(screened, base.fit.point.position.len());
            if state.screened.is_none() {
                refused.push(k);
            }
        }
        if level + 1 < LEVELS.len() && !refused.is_empty() {
            self.screen(level + 1, refused);
        } else {
            self.begin_extensions();
        }
    }
}
