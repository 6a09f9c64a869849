//! The screen of a rough model on its companion, which tells the candidates that are worth evaluations of the model.

use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::screen::{self, Evaluated, Screened};
use crate::effect_search::state::{CandidateState, EffectSearch, EvidenceEstimate, Phase};
use crate::laplace::batch::Asked;
use crate::laplace::correction::Correction;

impl EffectSearch {
    /// Screens what the companion has a form of on the companion, and the rest on the model.
    pub(super) fn begin_screen(&mut self) {
        let Some(base) = &self.base else { return };
        let base = &base.fit.point.position;
        let of_companion = |candidate: Option<usize>, position: Vec<f64>| Asked {
            candidate,
            position,
            is_companion: true,
        };
        let mut asked = vec![of_companion(None, base.clone())];
        for (k, state) in self.candidates.iter().enumerate() {
            if state.frame.has_companion {
                let at = screen::positions(&state.frame, base, self.depth, None, 0);
                asked.extend(at.into_iter().map(|position| of_companion(Some(k), position)));
            }
        }
        if asked.len() == 1 {
            return self.screen(0, (0..self.candidates.len()).collect());
        }
        self.ask(asked);
        self.phase = Phase::CompanionScreen;
    }

    /// The companion is a control variate: what a candidate changes of its predictions is added to those of the model's base.
    pub(super) fn after_companion_screen(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let Some(base) = &self.base else { return };
        let mut pairs = std::mem::take(&mut self.asked).into_iter().zip(answers);
        let without = pairs.next().and_then(|(_, values)| values);
        let shifted = |with: Vec<f64>| {
            let without = without.as_ref()?.iter();
            let changes = with.iter().zip(without).map(|(with, without)| with - without);
            let values = base.fit.point.values.iter().zip(changes);
            Some(values.map(|(value, change)| value + change).collect())
        };
        let mut evaluated: Vec<Vec<Evaluated>> = vec![Vec::new(); self.candidates.len()];
        for (asked, values) in pairs {
            if let Some(k) = asked.candidate {
                evaluated[k].push((asked.position, values.and_then(shifted)));
            }
        }
        for (state, evaluated) in self.candidates.iter_mut().zip(evaluated) {
            if evaluated.is_empty() {
                continue;
            }
            let screened = screen::screened(&state.frame, base, &self.likelihood, &evaluated);
            // What the companion does not show at all it cannot screen.
            state.by_companion = screened.filter(|own| own.change.iter().any(|change| *change != 0.0));
            if let Some(screened) = &state.by_companion {
                state.estimate = Some(EvidenceEstimate::of_screen(screened));
                state.screened = Some(screened.as_of_model());
            }
        }
        let wanted = self.worth_evaluations();
        self.screen(0, wanted);
    }

    /// What the companion could not screen, and the candidates with one strength that it lets near the best. A fit of several strengths
    /// begins at the base and needs the derivatives alone.
    fn worth_evaluations(&self) -> Vec<usize> {
        let promise = |k: &usize| {
            self.candidates[*k]
                .by_companion
                .as_ref()
                .map(|own| own.log_bayes_factor)
        };
        let all = || 0..self.candidates.len();
        let best = all().filter_map(|k| promise(&k)).fold(0.0, f64::max);
        let near = self.best(self.depth.most_extended);
        let is_worth = |k: &usize| {
            let Some(own) = promise(k) else { return true };
            let is_within_reach = self.depth.reach.is_some_and(|share| own > share * best);
            self.awaits_model(*k) && (near.contains(k) || is_within_reach)
        };
        all().filter(is_worth).collect()
    }

    /// The coordinate of the shapes that the companion found best; `None` where it was not asked, or there are none, or the model
    /// refused that shape.
    pub(super) fn best_shape(&self, candidate: usize) -> Option<f64> {
        let state = &self.candidates[candidate];
        let position = &state.by_companion.as_ref()?.point.position;
        let own = self.base_frame.dimension()..position.len();
        let mut shapes = own.filter(|k| !state.frame.is_strength(*k));
        shapes.next().map(|k| position[k])
    }

    /// Whether a candidate has a point of its own that the model has not evaluated.
    pub(super) fn awaits_model(&self, k: usize) -> bool {
        let state = &self.candidates[k];
        let is_of_companion = state.by_companion.is_some() && !state.is_screened_on_model;
        is_of_companion && state.frame.strength().is_some()
    }
}

impl CandidateState {
    /// Takes the result of the model's screen, with what the companion's says of the shapes.
    pub(super) fn take_screened(&mut self, screened: Option<Screened>, base_dimension: usize) {
        self.is_screened_on_model = true;
        self.screened = screened;
        if self.screened.is_none() {
            // Another shape may be possible.
            self.by_companion = None;
        }
        if let (Some(screened), Some(by_companion)) = (&mut self.screened, &self.by_companion) {
            for k in base_dimension..self.frame.dimension() {
                screened.corrections[k] = Some(Correction::none(screened.change.len()));
                if !self.frame.is_strength(k) {
                    screened.columns[k].clone_from(&by_companion.columns[k]);
                } else if screened.longest_step.to_bits() == by_companion.longest_step.to_bits() {
                    let own = Correction::between(&screened.change, &by_companion.change, true);
                    screened.corrections[k] = Some(own);
                }
            }
            screened.log_bayes_factor += by_companion.log_bayes_factor - by_companion.of_best_shape;
        }
        self.estimate = self.screened.as_ref().map(EvidenceEstimate::of_screen);
    }
}

impl Screened {
    /// As if the model changed as its companion does.
    fn as_of_model(&self) -> Self {
        let none = |column: &Vec<f64>| Some(Correction::none(column.len()));
        Self {
            corrections: self.columns.iter().map(none).collect(),
            ..self.clone()
        }
    }
}

impl EvidenceEstimate {
    fn of_screen(screened: &Screened) -> Self {
        Self {
            log_bayes_factor: screened.log_bayes_factor,
            stated_log_bayes_factor: screened.log_bayes_factor,
            method: EvidenceMethod::Screen,
            fit: None,
        }
    }
}
