//! The stage that exchanges effects of the best combination for others of their class.

use crate::effect_search::class::shortfall;
use crate::effect_search::projection::Projection;
use crate::effect_search::state::EffectSearch;
use crate::laplace::coordinate::NormalFrame;
use crate::search::branch::SearchBranch;
use crate::search::hypotheses::{EffectCombination, candidate_set};
use crate::search::stage::Stage;
use crate::search::state::SearchState;

/// Most exchanges at once, and most times that they are made: what takes the place of the best may have others of its class.
const MOST: usize = 4;
const ROUNDS: usize = 2;

impl SearchState {
    /// Fits the best combination with each of its effects exchanged for others of its class that have a fit of their own. What changes
    /// the predictions alike fits alike; on a model that scatters each fit may stop elsewhere, and evidences would tell the luck of the
    /// fits.
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

    pub(super) fn after_exchanges(&mut self, round: usize, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        self.exchanges(round + 1)
    }

    fn exchanged(&self, best: &EffectCombination) -> Vec<SearchBranch> {
        let ranking = &self.hypotheses.ranking;
        let class = |k: usize| Some(ranking.of(Some(k))?.class);
        let alike = |own: &usize| -> Vec<usize> {
            let others = ranking.ranked().into_iter().filter_map(|own| own.candidate);
            others.filter(|other| class(*other) == class(*own)).collect()
        };
        let alike: Vec<Vec<usize>> = best.effects.iter().map(alike).collect();
        // The places take turns, each from its best.
        let turns = (0..ranking.effects.len()).flat_map(|turn| {
            let places = alike.iter().enumerate();
            places.filter_map(move |(place, own)| Some((place, *own.get(turn)?)))
        });
        let branches = turns.filter_map(|(place, other)| {
            let mut effects = best.effects.clone();
            if effects.contains(&other) {
                return None;
            }
            effects.remove(place);
            let known = |effects: &[usize]| self.hypotheses.log_bayes_factor_of(&candidate_set(effects));
            let gain = best.log_bayes_factor - known(&effects).unwrap_or(0.0);
            effects.insert(place, other);
            let library = &self.task.library;
            let combines = effects
                .iter()
                .all(|k| *k == other || library[*k].combines_with(&library[other]));
            let least = best.log_bayes_factor - shortfall(gain);
            let is_fitted = self.hypotheses.exchanged.contains(&candidate_set(&effects))
                || known(&effects).is_some_and(|own| own > least);
            if is_fitted || !combines {
                return None;
            }
            let (frame, start) = self.in_place(best, place, other)?;
            let likelihood = self.task.likelihood.clone();
            let search = EffectSearch::refit(frame, vec![start], likelihood, self.task.settings.seed);
            Some(SearchBranch::new(effects, Vec::new(), search))
        });
        branches.take(MOST).collect()
    }

    /// The frame of a combination with another effect in one place, and where it predicts as the combination's fit does.
    fn in_place(
        &self,
        best: &EffectCombination,
        place: usize,
        other: usize,
    ) -> Option<(NormalFrame, Vec<f64>)> {
        let candidates = &self.hypotheses.candidates;
        let base = self.task.prior.dimension();
        let of_other = &self.hypotheses.single(other)?.fit;
        let (own, mut rest) = best.fit.point.position.split_at(base);
        let mut start = own.to_vec();
        let (mut frame, mut known) = (self.task.frame(), self.task.frame());
        let mut pair = None;
        for (i, &k) in best.effects.iter().enumerate() {
            known = known.with(&candidates[k]);
            let (its, others) = rest.split_at(candidates[k].parameters.len());
            rest = others;
            if i == place {
                frame = frame.with(&candidates[other]);
                start.extend_from_slice(&of_other.point.position[base..]);
                pair = Some((known.strength()?, frame.strength()?));
            } else {
                frame = frame.with(&candidates[k]);
                start.extend_from_slice(its);
            }
        }
        let ((taken, absent), given) = pair?;
        let change = of_other.columns[of_other.frame.strength()?.0].clone();
        let changes = [change, best.fit.columns[taken].clone()];
        let projection = Projection::new(self.hypotheses.base_fit()?, &self.task.likelihood)?;
        let exchange = projection.exchange(changes, best.fit.point.position[taken] - absent);
        let start = exchange.applied_to(start, given);
        frame.holds(&start).then_some((frame, start))
    }
}
