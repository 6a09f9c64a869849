//! Step 12, the replacements: the base is fitted with each leading effect in the place of each of its effects.
//!
//! An effect of the base may have been added before the data could tell it from another. The other then improves the model that has both,
//! and explains the data alone.

use crate::effect_search::state::EffectSearch;
use crate::laplace::fit::FittedModel;
use crate::probability::DETECTED;
use crate::stages::branch::SearchBranch;
use crate::stages::hypotheses::FittedReplacement;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;
use crate::stages::weighing::Weighing;

/// Maximum number of leading effects.
const LEADERS: usize = 2;
/// An effect whose log probability is lower than that of the most probable by more than this does not lead \[nats\].
const NEAR: f64 = 5.0;

impl SearchState {
    /// Fits the base with each leading effect in the place of each effect that it may replace.
    pub(super) fn replacements(&self) -> Stage {
        let leaders = self.leaders();
        let reductions = self.hypotheses.reduced.iter().enumerate();
        let branches = reductions.flat_map(|(k, reduced)| {
            let substitutes = &self.task.reductions[k].substitutes;
            let leaders = leaders.iter().filter(|leader| substitutes.contains(leader));
            leaders.filter_map(move |leader| self.replacement(k, reduced.as_ref()?, *leader))
        });
        let branches: Vec<SearchBranch> = branches.collect();
        if branches.is_empty() {
            return self.predictions();
        }
        Stage::Replacements(branches)
    }

    /// Keeps the replacements, and begins the predictions.
    pub(super) fn after_replacements(&mut self, branches: &[SearchBranch]) -> Stage {
        let base = self.hypotheses.base_evidence();
        let fitted = branches.iter().filter_map(|branch| {
            let fitted = branch.search.base_fit()?;
            let likelihood = &branch.search.likelihood;
            // The effect that is replaced has its stated prior alone, so the candidate gains nothing by a wider one.
            let stated = fitted.fit.stated_gain(likelihood)?.min(0.0);
            Some(FittedReplacement {
                reduction: branch.reduction?,
                candidate: *branch.effects.first()?,
                log_bayes_factor: fitted.log_evidence + stated - base,
                fit: fitted.fit.clone(),
                likelihood: likelihood.clone(),
            })
        });
        self.hypotheses.replacements = fitted.collect();
        self.predictions()
    }

    /// Returns the most probable effects, those that improve the base by a detectable amount.
    fn leaders(&self) -> Vec<usize> {
        if self.hypotheses.detected().is_none() || self.hypotheses.reduced.is_empty() {
            return Vec::new();
        }
        let weighing = Weighing::new(&self.task, &self.hypotheses);
        let mut leaders: Vec<(usize, f64)> = weighing
            .ranking
            .effects
            .iter()
            .filter(|effect| effect.log_bayes_factor > DETECTED)
            .filter_map(|effect| Some((effect.candidate?, effect.probability)))
            .collect();
        leaders.sort_by(|a, b| b.1.total_cmp(&a.1));
        let highest = leaders.first().map_or(0.0, |(_, probability)| *probability);
        leaders.retain(|(_, probability)| *probability > highest * libm::exp(-NEAR));
        leaders.truncate(LEADERS);
        leaders.into_iter().map(|(k, _)| k).collect()
    }

    /// Returns the fit of a reduction with a candidate. It begins where the candidate improves the base, without the effect that it
    /// replaces, or at the reduction's fit, whichever is more probable.
    fn replacement(&self, k: usize, reduced: &FittedModel, candidate: usize) -> Option<SearchBranch> {
        let single = &self.hypotheses.single(candidate)?.fit;
        let base = self.task.prior.dimension();
        let frame = reduced.fit.frame.with(&self.hypotheses.candidates[candidate]);
        let theta = single.theta();
        let reduction = &self.task.reductions[k];
        let kept = reduction.parameters.iter().copied();
        let kept: Vec<f64> = kept.chain(base..theta.len()).map(|i| theta[i]).collect();
        let strengths = &single.point.position[base..];
        let at_reduction = [&reduced.fit.point.position, strengths].concat();
        let starts = vec![frame.position(&kept), at_reduction];
        let likelihood = self.task.reduced_likelihood(reduction)?;
        let search = EffectSearch::refit(frame, starts, likelihood, self.task.settings.seed);
        Some(SearchBranch::without(k, vec![candidate], search))
    }
}
