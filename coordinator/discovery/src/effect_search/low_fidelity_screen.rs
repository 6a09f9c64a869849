//! Phase 2 of a rough model with a low-fidelity model: its screen on that model, which selects the candidates that are worth
//! evaluations of the model.

use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::screen;
use crate::effect_search::screen_result::{self, Evaluated, Screened};
use crate::effect_search::state::{CandidateState, EffectSearch, EvidenceEstimate, Phase};
use crate::laplace::batch::PositionRequest;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::Correction;
use crate::probability::DETECTED;

impl EffectSearch {
    /// Screens the candidates that the low-fidelity model has on that model, and the others on the model.
    pub(super) fn screen_low_fidelity(&mut self) {
        let Some(base) = &self.base else { return };
        let base = &base.fit.point.position;
        let low_fidelity = |candidate: Option<usize>, position: Vec<f64>| PositionRequest {
            candidate,
            position,
            is_low_fidelity: true,
        };
        let mut requests = vec![low_fidelity(None, base.clone())];
        for (k, state) in self.candidates.iter().enumerate() {
            if state.frame.has_low_fidelity {
                let at = screen::positions(&state.frame, base, &self.depth.screen, None, 0);
                requests.extend(at.into_iter().map(|position| low_fidelity(Some(k), position)));
            }
        }
        if requests.len() == 1 {
            return self.screen(0, self.worth_evaluations());
        }
        self.ask(requests);
        self.phase = Phase::LowFidelityScreen;
    }

    /// Uses the low-fidelity model as a control variate: the changes that a candidate makes to its predictions are added to the
    /// predictions of the model's base.
    pub(super) fn take_low_fidelity_screen(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let Some(base) = &self.base else { return };
        let mut pairs = std::mem::take(&mut self.requests).into_iter().zip(answers);
        let without = pairs.next().and_then(|(_, values)| values);
        let shifted = |with: Vec<f64>| {
            let without = without.as_ref()?.iter();
            let changes = with.iter().zip(without).map(|(with, without)| with - without);
            let values = base.fit.point.values.iter().zip(changes);
            Some(values.map(|(value, change)| value + change).collect())
        };
        let mut evaluated: Vec<Vec<Evaluated>> = vec![Vec::new(); self.candidates.len()];
        for (request, values) in pairs {
            if let Some(k) = request.candidate {
                evaluated[k].push((request.position, values.and_then(shifted)));
            }
        }
        for (state, evaluated) in self.candidates.iter_mut().zip(evaluated) {
            if evaluated.is_empty() {
                continue;
            }
            let screened = screen_result::screened(&state.frame, base, &self.likelihood, &evaluated);
            // A candidate that does not change the low-fidelity predictions must be screened on the model.
            let changes = |screened: &Screened| screened.change.iter().any(|change| *change != 0.0);
            if let Some(screened) = screened.filter(changes) {
                state.take_low_fidelity(screened);
            }
        }
        let candidates = self.worth_evaluations();
        self.screen(0, candidates);
    }

    /// Returns candidates that were not screened without the model, and those with one strength that it ranks near the best.
    /// A candidate with several strengths begins its fit at the base and needs derivatives alone.
    fn worth_evaluations(&self) -> Vec<usize> {
        let promise = |k: &usize| {
            self.candidates[*k]
                .low_fidelity
                .as_ref()
                .map(|screened| screened.log_bayes_factor)
        };
        let all = || 0..self.candidates.len();
        let best = all().filter_map(|k| promise(&k)).fold(DETECTED, f64::max);
        let near = self.best(self.depth.screen.max_on_model);
        let is_worth = |k: &usize| {
            let Some(factor) = promise(k) else { return true };
            let is_within_reach = self
                .depth
                .extension
                .reach
                .is_some_and(|share| factor > share * best);
            self.awaits_model(*k) && (near.contains(k) || is_within_reach)
        };
        all().filter(is_worth).collect()
    }

    /// Returns whether a candidate's screen on the low-fidelity model must be repeated on the model.
    pub(super) fn awaits_model(&self, k: usize) -> bool {
        let state = &self.candidates[k];
        let awaits_screen = state.low_fidelity.is_some() && !state.is_screened_on_model;
        awaits_screen && state.frame.strength().is_some()
    }
}

impl CandidateState {
    /// Takes the result of the screen on the model. Derivatives along shapes, and the mean over them, come from the low-fidelity
    /// screen.
    pub(super) fn take_screened(&mut self, screened: Option<Screened>, base_dimension: usize) {
        self.is_screened_on_model = true;
        self.screened = screened;
        if let (Some(screened), Some(low_fidelity)) = (&mut self.screened, &self.low_fidelity) {
            for k in base_dimension..self.frame.dimension() {
                screened.corrections[k] = Some(Correction::none(screened.change.len()));
                if !self.frame.is_strength(k) {
                    screened.columns[k].clone_from(&low_fidelity.columns[k]);
                } else if screened.longest_step.to_bits() == low_fidelity.longest_step.to_bits() {
                    let correction = Correction::between(&screened.change, &low_fidelity.change, true);
                    screened.corrections[k] = Some(correction);
                }
            }
            screened.log_bayes_factor +=
                low_fidelity.log_bayes_factor - low_fidelity.best_shape_log_bayes_factor;
        }
        self.estimate = self.screened.as_ref().map(EvidenceEstimate::of_screen);
    }
}

impl Screened {
    /// Returns the coordinates of the shapes that fit best; none where the candidate has no shape.
    pub(super) fn shape(&self, frame: &NormalFrame, base_dimension: usize) -> Vec<f64> {
        let added = base_dimension..self.point.position.len();
        added
            .filter(|k| !frame.is_strength(*k))
            .map(|k| self.point.position[k])
            .collect()
    }

    /// Returns this result with corrections of zero, as if the model changed as the low-fidelity model does.
    pub(super) fn as_of_model(&self) -> Self {
        let none = |column: &Vec<f64>| Some(Correction::none(column.len()));
        Self {
            corrections: self.columns.iter().map(none).collect(),
            ..self.clone()
        }
    }
}

impl EvidenceEstimate {
    pub(super) fn of_screen(screened: &Screened) -> Self {
        Self {
            log_bayes_factor: screened.log_bayes_factor,
            stated_log_bayes_factor: screened.log_bayes_factor,
            method: EvidenceMethod::Screen,
            fit: None,
        }
    }
}
