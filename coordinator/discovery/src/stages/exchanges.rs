//! Step 8, the exchanges: with numerical noise, each effect of the best combination is replaced by other members of its class.

use crate::effect_search::class::log_bayes_factor_deficit;
use crate::effect_search::projection::Projection;
use crate::effect_search::state::EffectSearch;
use crate::laplace::coordinate::NormalFrame;
use crate::stages::branch::SearchBranch;
use crate::stages::hypotheses::{EffectCombination, candidate_set};
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

/// Maximum number of exchanges in a round, and of rounds: the new best combination may have exchanges too.
const MAX_EXCHANGES: usize = 4;
const ROUNDS: usize = 2;

impl SearchState {
    /// Fits the best combination with each of its effects replaced by a member of its class that has a fit. Effects that change
    /// the predictions alike fit alike, but with numerical noise each fit may stop at another local maximum, and evidences would
    /// reflect that.
    pub(super) fn exchanges(&mut self, round: usize) -> Stage {
        let branches = match self.hypotheses.detected() {
            Some(best) if round < ROUNDS && !self.numerical_noise_sds.is_empty() => self.exchanged(best),
            _ => Vec::new(),
        };
        if branches.is_empty() {
            return self.curves();
        }
        let tried = branches.iter().map(|branch| candidate_set(&branch.effects));
        self.hypotheses.exchanged.extend(tried);
        Stage::Exchanges(round, branches)
    }

    /// Keeps the exchanged combinations, and exchanges once more beyond the best of them.
    pub(super) fn after_exchanges(&mut self, round: usize, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        self.exchanges(round + 1)
    }

    /// Returns the fits of the combination with one effect exchanged.
    fn exchanged(&self, best: &EffectCombination) -> Vec<SearchBranch> {
        let ranking = &self.hypotheses.ranking;
        let class = |k: usize| Some(ranking.effect(Some(k))?.class);
        let same_class = |effect: &usize| -> Vec<usize> {
            let candidates = ranking.ranked().into_iter().filter_map(|ranked| ranked.candidate);
            candidates.filter(|k| class(*k) == class(*effect)).collect()
        };
        let same_class: Vec<Vec<usize>> = best.effects.iter().map(same_class).collect();
        // The effects take turns, each with its best substitute first.
        let turns = (0..ranking.effects.len()).flat_map(|turn| {
            let places = same_class.iter().enumerate();
            places.filter_map(move |(place, candidates)| Some((place, *candidates.get(turn)?)))
        });
        let branches = turns.filter_map(|(place, substitute)| {
            let mut effects = best.effects.clone();
            if effects.contains(&substitute) {
                return None;
            }
            effects.remove(place);
            let log_bayes_factor =
                |effects: &[usize]| self.hypotheses.log_bayes_factor_of(&candidate_set(effects));
            let gain = best.log_bayes_factor - log_bayes_factor(&effects).unwrap_or(0.0);
            effects.insert(place, substitute);
            let library = &self.task.library;
            let combines = effects
                .iter()
                .all(|k| *k == substitute || library[*k].combines_with(&library[substitute]));
            let expected = best.log_bayes_factor - log_bayes_factor_deficit(gain);
            let is_fitted = self.hypotheses.exchanged.contains(&candidate_set(&effects))
                || log_bayes_factor(&effects).is_some_and(|factor| factor > expected);
            if is_fitted || !combines {
                return None;
            }
            let (frame, start) = self.in_place(best, place, substitute)?;
            let likelihood = self.task.likelihood.clone();
            let search = EffectSearch::refit(frame, vec![start], likelihood, self.task.settings.seed);
            Some(SearchBranch::new(effects, Vec::new(), search))
        });
        branches.take(MAX_EXCHANGES).collect()
    }

    /// Returns the frame of a combination with one effect replaced, and a start at which it predicts as the combination's fit does.
    fn in_place(
        &self,
        best: &EffectCombination,
        place: usize,
        substitute: usize,
    ) -> Option<(NormalFrame, Vec<f64>)> {
        let candidates = &self.hypotheses.candidates;
        let base = self.task.prior.dimension();
        let single = &self.hypotheses.single(substitute)?.fit;
        let mut start = best.fit.point.position[..base].to_vec();
        let (mut frame, mut old_frame) = (self.task.frame(), self.task.frame());
        let mut pair = None;
        for (i, (k, coordinates)) in self.coordinates(best).enumerate() {
            old_frame = old_frame.with(&candidates[k]);
            if i == place {
                frame = frame.with(&candidates[substitute]);
                start.extend_from_slice(&single.point.position[base..]);
                pair = Some((old_frame.strength()?, frame.strength()?));
            } else {
                frame = frame.with(&candidates[k]);
                start.extend_from_slice(coordinates);
            }
        }
        let ((replaced, absent), strength) = pair?;
        let change = single.columns[single.frame.strength()?.0].clone();
        let changes = [change, best.fit.columns[replaced].clone()];
        let projection = Projection::new(self.hypotheses.base_fit()?, &self.task.likelihood)?;
        let exchange = projection.exchange(changes, best.fit.point.position[replaced] - absent);
        let start = exchange.applied_to(start, strength);
        frame.holds(&start).then_some((frame, start))
    }
}
