//! The end of phase 5: where Laplace's approximation is uncertain, the evidence is computed by importance sampling.

use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::state::{EffectSearch, Phase};
use crate::laplace::batch::PositionRequest;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::importance::ImportanceSampler;

/// Two effects whose log Bayes factors differ by less than this are compared by importance sampling \[nats\].
const CLOSE: f64 = 3.0;
/// Importance sampling is used only if the log Bayes factor of the best effect exceeds this \[nats\].
const MIN_CLAIMED: f64 = 1.0;
/// Beyond this log Bayes factor the posterior of a strength excludes its absence \[nats\].
const CERTAINLY_PRESENT: f64 = 10.0;
/// Maximum number of sampled effects, which bounds the cost if several lead in turn.
const MAX_SAMPLED: usize = 3;
/// Within this distance from the absence of the effect, in standard deviations of its prior, the prior of a strength is not normal.
const NEARLY_ABSENT: f64 = 0.1;

/// One of the two best candidates, with its fit.
struct Best<'a> {
    candidate: usize,
    log_bayes_factor: f64,
    fit: &'a LaplaceFit,
}

impl EffectSearch {
    /// Returns samplers of the base and the best effect, if a parameter of either is at a bound or the effect is nearly absent,
    /// and of the second effect if it is close and of another class. Models that were sampled before are left out. A rough model
    /// has none.
    pub(super) fn samplers(&self) -> Vec<(Option<usize>, ImportanceSampler)> {
        let none = Vec::new();
        let (Some(base), Some((first, rest))) = (&self.base, self.fits_of_best()) else {
            return none;
        };
        let samples = self
            .depth
            .confirmation
            .as_ref()
            .is_some_and(|depth| depth.samples);
        let is_needless = !samples || first.log_bayes_factor < MIN_CLAIMED;
        if is_needless || self.sampled.len() > MAX_SAMPLED {
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
        let base_sampler = || Some((None, ImportanceSampler::new(&base.fit, &self.likelihood)?));
        let effect_sampler = |best: Best| {
            let sampler = ImportanceSampler::new(best.fit, &self.likelihood)?;
            let may_be_absent = best.log_bayes_factor < CERTAINLY_PRESENT;
            let sampler = if may_be_absent {
                sampler.or_absent(&base.fit, &self.likelihood)
            } else {
                sampler
            };
            Some((Some(best.candidate), sampler))
        };
        let effects = std::iter::once(first).chain(second).filter_map(effect_sampler);
        base_sampler()
            .into_iter()
            .chain(effects)
            .filter(|(candidate, _)| !self.sampled.contains_key(candidate))
            .collect()
    }

    /// Returns the best effect and the second, with their fits.
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

    /// Replaces the log Bayes factors of sampled effects by the ratio of sampled evidences. The others keep Laplace's approximation
    /// on both sides, whose errors at a common bound cancel.
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

    /// Asks for the next draws of each importance sampler; the search ends once all samplers are done and no other is needed.
    pub(super) fn sample(&mut self, mut models: Vec<(Option<usize>, ImportanceSampler)>) {
        let mut requests = Vec::new();
        let mut counts = Vec::new();
        for (candidate, model) in &mut models {
            let number = candidate.map_or(0, |k| k as u64 + 1);
            let positions = model.ask(self.seed, number);
            counts.push(positions.len());
            requests.extend(PositionRequest::all_for_model(*candidate, positions));
        }
        if requests.is_empty() {
            self.take_sampled(&models);
            // Another effect may lead now.
            let samplers = self.samplers();
            return if samplers.is_empty() {
                self.finish()
            } else {
                self.sample(samplers)
            };
        }
        self.ask(requests);
        self.phase = Phase::Sampling(models, counts);
    }

    /// Takes the predicted values at the draws of each importance sampler.
    pub(super) fn take_sample(
        &mut self,
        mut models: Vec<(Option<usize>, ImportanceSampler)>,
        counts: &[usize],
        answers: Vec<Option<Vec<f64>>>,
    ) {
        self.evaluations.confirmation += answers.len();
        let mut answers = answers.into_iter();
        for ((_, model), count) in models.iter_mut().zip(counts) {
            if *count > 0 {
                model.tell(&self.likelihood, answers.by_ref().take(*count).collect());
            }
        }
        self.sample(models);
    }
}
