//! Step 11, the effects in the place of a law: the best set that has a law is fitted with effects of the library instead of the law.
//!
//! A law may stand for an effect that no earlier stage found, because it was screened at the best fit without both: where that fit is
//! bad, the effect changes the predictions differently than beside the right effects.

use crate::effect_search::projection::Projection;
use crate::effect_search::state::EffectSearch;
use crate::stages::branch::SearchBranch;
use crate::stages::hypotheses::{EffectCombination, candidate_set};
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

/// Maximum number of effects that are fitted in the place of a law.
const MAX_SUBSTITUTES: usize = 4;
/// A set with less log evidence than that with the law by more than this is fitted again \[nats\].
const NEAR: f64 = 5.0;

/// A set with a law, taken apart at its fit.
struct WithoutLaw<'a> {
    set: &'a EffectCombination,
    /// The other members.
    kept: Vec<usize>,
    /// Position of the fit without the coordinates of the law.
    position: Vec<f64>,
    /// The change of the predictions by the law.
    change: Vec<f64>,
    /// The projection out of what base and other members absorb.
    projection: Projection,
}

/// An effect with its coordinates in the best set that has it.
struct Substitute {
    effect: usize,
    coordinates: Vec<f64>,
    /// The change of the predictions by a step of the strength.
    change: Vec<f64>,
}

impl SearchState {
    /// Fits the effects that change the predictions most as the law of the best set does, in its place.
    pub(super) fn law_substitutes(&mut self) -> Stage {
        let best = self.best_with_law();
        let without = best.and_then(|best| self.without_law(best));
        let branches = without.map_or_else(Vec::new, |without| self.with_substitutes(&without));
        if branches.is_empty() {
            return self.law_validation();
        }
        Stage::LawSubstitutes(branches)
    }

    pub(super) fn after_law_substitutes(&mut self, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        self.law_validation()
    }

    /// Takes the law out of a set; `None` where the data cannot be whitened at the fit of the set.
    fn without_law<'a>(&'a self, set: &'a EffectCombination) -> Option<WithoutLaw<'a>> {
        let fit = &set.fit;
        let mut frame = self.task.frame();
        let mut position = fit.point.position[..frame.dimension()].to_vec();
        let mut change = vec![0.0; fit.point.values.len()];
        let (mut kept, mut of_law) = (Vec::new(), Vec::new());
        for (k, coordinates) in self.coordinates(set) {
            let first = frame.dimension();
            frame = frame.with(&self.hypotheses.candidates[k]);
            if !self.task.is_law(k) {
                kept.push(k);
                position.extend_from_slice(coordinates);
                continue;
            }
            of_law.extend(first..frame.dimension());
            for &(strength, absent) in &frame.strengths {
                let step = fit.point.position[strength] - absent;
                let column = fit.columns[strength].iter();
                change
                    .iter_mut()
                    .zip(column)
                    .for_each(|(sum, by)| *sum += step * by);
            }
        }
        Some(WithoutLaw {
            set,
            kept,
            position,
            change,
            projection: Projection::without(fit, &self.task.likelihood, &of_law)?,
        })
    }

    /// Returns the fits with one effect in the place of the law.
    fn with_substitutes(&self, without: &WithoutLaw) -> Vec<SearchBranch> {
        let is_unfitted = |k: &usize| {
            let mut effects = candidate_set(&without.kept);
            effects.insert(*k);
            let fitted = self.hypotheses.log_bayes_factor_of(&effects);
            fitted.is_none_or(|factor| factor < without.set.log_bayes_factor - NEAR)
        };
        let effects = self
            .further_effects(&without.kept)
            .into_iter()
            .filter(is_unfitted);
        let aligned = effects.filter_map(|k| {
            let substitute = self.substitute(k)?;
            let changes = [substitute.change.clone(), without.change.clone()];
            Some((without.projection.alignment(&changes), substitute))
        });
        let mut aligned: Vec<(f64, Substitute)> = aligned.collect();
        aligned.sort_by(|a, b| b.0.total_cmp(&a.0));
        aligned.truncate(MAX_SUBSTITUTES);
        let branches = aligned
            .iter()
            .map(|(_, substitute)| self.in_place_of_law(without, substitute));
        branches.collect()
    }

    /// Returns an effect as the best set has it; `None` if it has several strengths or was fitted in no set.
    fn substitute(&self, effect: usize) -> Option<Substitute> {
        let strengths = &self.hypotheses.candidates[effect].strengths;
        let &[strength] = strengths.as_slice() else {
            return None;
        };
        let mut sets = self.hypotheses.combinations.iter();
        let set = sets.find(|set| set.effects.contains(&effect))?;
        let mut first = self.task.prior.dimension();
        for (k, coordinates) in self.coordinates(set) {
            if k == effect {
                return Some(Substitute {
                    effect,
                    coordinates: coordinates.to_vec(),
                    change: set.fit.columns[first + strength].clone(),
                });
            }
            first += coordinates.len();
        }
        None
    }

    /// Returns the fit of a set with an effect in the place of its law. It begins where the effect changes the predictions as the law did,
    /// or with the strength of the best set that has the effect, whichever is more probable.
    fn in_place_of_law(&self, without: &WithoutLaw, substitute: &Substitute) -> SearchBranch {
        let candidates = &self.hypotheses.candidates;
        let effects = [without.kept.as_slice(), &[substitute.effect]].concat();
        let frame = effects
            .iter()
            .fold(self.task.frame(), |frame, &k| frame.with(&candidates[k]));
        let start = [without.position.as_slice(), &substitute.coordinates].concat();
        let changes = [substitute.change.clone(), without.change.clone()];
        let exchange = without.projection.exchange(changes, 1.0);
        let exchanged = frame
            .strength()
            .map(|strength| exchange.applied_to(start.clone(), strength));
        let mut starts = vec![start];
        starts.extend(exchanged.filter(|start| frame.holds(start)));
        let search = EffectSearch::refit(
            frame,
            starts,
            self.task.likelihood.clone(),
            self.task.settings.seed,
        );
        SearchBranch::new(effects, Vec::new(), search)
    }
}
