//! The models whose evidence is sampled, because Laplace's approximation of it is doubtful.

use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::state::EffectSearch;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::importance::ImportanceSampler;

/// Two effects with closer Bayes factors are compared by importance sampling \[nats\].
const CLOSE: f64 = 3.0;
/// Least log Bayes factor of the best effect for which importance sampling is worth its evaluations \[nats\].
const LEAST_CLAIMED: f64 = 1.0;
/// Beyond this log Bayes factor the posterior of a strength excludes its absence \[nats\].
const CERTAINLY_PRESENT: f64 = 10.0;
/// Most effects that are sampled, which bounds the cost where many lead in turn.
const MOST_SAMPLED: usize = 3;
/// A strength within so many standard deviations of its prior from where the effect is absent lies where the prior is not normal.
const NEARLY_ABSENT: f64 = 0.1;

/// One of the best effects.
struct Best<'a> {
    candidate: usize,
    log_bayes_factor: f64,
    fit: &'a LaplaceFit,
}

impl EffectSearch {
    /// Samplers of the base and the best effect, where Laplace's approximation is doubtful: a parameter of either is at a bound, or the
    /// effect is nearly absent; and of the second effect where it is close and of another class. None of what was sampled before, and none of a
    /// rough model.
    pub(super) fn samplers(&self) -> Vec<(Option<usize>, ImportanceSampler)> {
        let none = Vec::new();
        let (Some(base), Some((first, rest))) = (&self.base, self.fits_of_best()) else {
            return none;
        };
        let is_in_vain = !self.depth.samples || first.log_bayes_factor < LEAST_CLAIMED;
        if is_in_vain || self.sampled.len() > MOST_SAMPLED {
            return none;
        }
        let classes = self.projected().map(|projected| projected.classes);
        let classes = classes.unwrap_or_default();
        let is_close = |second: &Best| {
            first.log_bayes_factor - second.log_bayes_factor < CLOSE
                && classes.get(&first.candidate) != classes.get(&second.candidate)
        };
        let second = rest.filter(is_close);
        let is_at_bound = |fit: &LaplaceFit| fit.frame.at_bound(&fit.point.position).contains(&true);
        let position = &first.fit.point.position;
        let strength = first.fit.frame.strength();
        let is_nearly_absent =
            strength.is_some_and(|(k, neutral)| (position[k] - neutral).abs() < NEARLY_ABSENT);
        if second.is_none() && !is_nearly_absent && !is_at_bound(&base.fit) && !is_at_bound(first.fit) {
            return none;
        }
        let of_base = || Some((None, ImportanceSampler::new(&base.fit, &self.likelihood)?));
        let of_effect = |best: Best| {
            let sampler = ImportanceSampler::new(best.fit, &self.likelihood)?;
            let may_be_absent = best.log_bayes_factor < CERTAINLY_PRESENT;
            let sampler = if may_be_absent {
                sampler.or_absent(&base.fit, &self.likelihood)
            } else {
                sampler
            };
            Some((Some(best.candidate), sampler))
        };
        let effects = std::iter::once(first).chain(second).filter_map(of_effect);
        of_base()
            .into_iter()
            .chain(effects)
            .filter(|(candidate, _)| !self.sampled.contains_key(candidate))
            .collect()
    }

    /// The best effect and the second, with their fits.
    fn fits_of_best(&self) -> Option<(Best<'_>, Option<Best<'_>>)> {
        let mut best = self.best(2).into_iter().filter_map(|candidate| {
            let estimate = self.candidates[candidate].estimate.as_ref()?;
            Some(Best {
                candidate,
                log_bayes_factor: estimate.log_bayes_factor,
                fit: estimate.fit.as_ref()?,
            })
        });
        Some((best.next()?, best.next()))
    }

    /// Takes the evidence of the sampled effects over the sampled base. Other factors keep Laplace's approximation of both, whose errors at
    /// a common bound cancel.
    pub(super) fn take_sampled(&mut self, models: &[(Option<usize>, ImportanceSampler)]) {
        let evidences = models
            .iter()
            .map(|(candidate, model)| (*candidate, model.log_evidence()));
        self.sampled.extend(evidences);
        let Some(base) = self.sampled.get(&None).copied().flatten() else {
            return;
        };
        for (candidate, model) in models {
            let estimate = candidate.and_then(|k| self.candidates[k].estimate.as_mut());
            if let (Some(estimate), Some(evidence)) = (estimate, model.log_evidence()) {
                estimate.log_bayes_factor = evidence - base;
                estimate.stated_log_bayes_factor = estimate.log_bayes_factor + model.stated_gain();
                estimate.method = EvidenceMethod::Sampled;
            }
        }
    }
}
