//! The probabilities of all hypotheses, from which predictions, next runs and verdict follow (steps 12 and 13).

use std::collections::BTreeMap;

use crate::effect_search::ranking::{EffectRanking, EvidenceMethod, RankedEffect};
use crate::laplace::evidence::log_sum_exp;
use crate::probability::{DETECTED, ModelProbability, Probabilities};
use crate::stages::hypotheses::{EffectCombination, Hypotheses};
use crate::stages::next_run::OpenHypothesis;
use crate::task::SearchTask;

/// Further runs do not compare explanations that are less probable.
const OPEN: f64 = 0.005;
/// Maximum number of explanations that further runs compare.
const MAX_OPEN: usize = 12;
/// Less probable sets are not compared by prediction.
const LEADING: f64 = 0.01;
/// Maximum number of sets that predict left-out levels.
const MAX_LEADING: usize = 4;

/// A model that explains the data: nothing is missing, effects that act together, or a law outside the library.
#[derive(Debug, Clone, PartialEq)]
pub struct WeighedSet {
    /// The effects, empty if nothing is missing; `None` for a law outside the library.
    pub effects: Option<Vec<usize>>,
    /// Log evidence over that of the base.
    pub log_bayes_factor: f64,
    /// Prior probability.
    pub prior: f64,
    /// Posterior probability; over all sets they sum to 1.
    pub probability: f64,
    /// Log predictive density of left-out levels over that of the base, each measurement counted once; `None` if it was not
    /// computed.
    pub predictive: Option<f64>,
}

/// The probabilities of single effects and of all other models.
pub(super) struct Weighing {
    pub(super) ranking: EffectRanking,
    /// Log Bayes factor and probability of a law outside the library; `None`: not searched.
    pub(super) not_in_library: Option<(f64, f64)>,
    /// Every model, by falling probability.
    pub(super) sets: Vec<WeighedSet>,
    /// Chi-square of the best explanation over its degrees of freedom; 1 where it fits.
    pub(super) misfit: f64,
    inclusion: Inclusion,
}

/// A combination that counts for its leading effect.
struct LedCombination<'a> {
    effects: &'a [usize],
    log_bayes_factor: f64,
    /// Log prior cost of the effects after the first.
    cost: f64,
}

/// Log of the summed weights of the combinations that include each effect of the library.
type Inclusion = BTreeMap<usize, f64>;

/// Two effects whose log inclusion weights differ by less count as equally included: such a difference depends on which poor
/// combinations were tried.
const SAME_WEIGHT: f64 = 0.01;

/// Sums the weights of the combinations that include each effect.
fn inclusion(hypotheses: &Hypotheses, cost: f64, misfit: f64) -> Inclusion {
    let mut weights: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for combination in &hypotheses.combinations {
        let cost = cost * (combination.effects.len() as f64 - 1.0);
        for &k in &combination.effects {
            let factor = combination.log_bayes_factor / misfit - cost;
            weights.entry(k).or_default().push(factor);
        }
    }
    let sum = |(k, weights): (usize, Vec<f64>)| (k, log_sum_exp(weights.into_iter()));
    weights.into_iter().map(sum).collect()
}

/// Returns the effect of a combination with the highest inclusion weight; among equals, the one with the highest Bayes factor
/// alone. `None` without an effect of the library. Of the effects of a combination, the one that all good combinations share is
/// named, not one that only some have.
fn leader(ranking: &EffectRanking, inclusion: &Inclusion, effects: &[usize]) -> Option<usize> {
    let ranked = || effects.iter().filter_map(|&k| ranking.effect(Some(k)));
    let weight = |effect: &RankedEffect| {
        let weight = effect.candidate.and_then(|k| inclusion.get(&k));
        weight.copied().unwrap_or(f64::NEG_INFINITY)
    };
    let highest = ranked().map(weight).fold(f64::NEG_INFINITY, f64::max);
    let best = ranked().filter(|effect| weight(effect) >= highest - SAME_WEIGHT);
    let best = best.reduce(|a, b| {
        let by_factor = b.log_bayes_factor.total_cmp(&a.log_bayes_factor);
        if by_factor.then(a.candidate.cmp(&b.candidate)).is_gt() {
            b
        } else {
            a
        }
    });
    best.and_then(|effect| effect.candidate)
}

/// Returns whether a set without an effect predicts left-out levels better than every set with it. Sets that have the effect
/// differ in other effects only.
fn disputes(sets: &[WeighedSet], effect: usize, misfit: f64) -> bool {
    let highest = |has: bool| {
        let sets = sets
            .iter()
            .filter(|set| set.effects.as_ref().is_some_and(|e| e.contains(&effect)) == has);
        sets.filter_map(|set| set.predictive).reduce(f64::max)
    };
    match (highest(true), highest(false)) {
        (Some(with), Some(without)) => (without - with) / misfit > DETECTED,
        _ => false,
    }
}

/// Returns the ranking of the single effects, with the better fits that the backward elimination may have found.
fn updated_ranking(task: &SearchTask, hypotheses: &Hypotheses) -> EffectRanking {
    let mut ranking = hypotheses.ranking.clone();
    for effect in &mut ranking.effects {
        let single = effect.candidate.and_then(|k| hypotheses.single(k));
        // Another mode replaces a sampled evidence; Laplace's approximation of the same mode does not.
        let min_factor = match effect.method {
            EvidenceMethod::Sampled => effect.log_bayes_factor + DETECTED,
            _ => effect.log_bayes_factor,
        };
        if let Some(single) = single.filter(|s| s.log_bayes_factor > min_factor) {
            effect.log_bayes_factor = single.log_bayes_factor;
            let gain = single.fit.stated_gain(&task.likelihood).unwrap_or(0.0);
            effect.stated_log_bayes_factor = single.log_bayes_factor + gain;
            effect.log_likelihood = single.fit.point.log_likelihood(&single.fit.frame);
            effect.prior_sds = single.fit.frame.strength_distance(&single.fit.point.position);
            effect.theta = single.fit.theta();
            effect.predicted.clone_from(&single.fit.point.values);
            effect.at_bound = single.fit.frame.at_bound(&single.fit.point.position);
        }
    }
    ranking
}

/// The combinations of two effects and more, by their leading effect.
struct LedCombinations<'a>(BTreeMap<usize, Vec<LedCombination<'a>>>);

impl<'a> LedCombinations<'a> {
    /// Groups the combinations by their leading effect.
    ///
    /// # Arguments
    /// - `cost`: log prior cost of each effect after the first.
    fn new(hypotheses: &'a Hypotheses, ranking: &EffectRanking, inclusion: &Inclusion, cost: f64) -> Self {
        let mut led: BTreeMap<usize, Vec<LedCombination>> = BTreeMap::new();
        for combination in hypotheses.combinations.iter().filter(|c| c.effects.len() > 1) {
            if let Some(leader) = leader(ranking, inclusion, &combination.effects) {
                led.entry(leader).or_default().push(LedCombination {
                    effects: &combination.effects,
                    log_bayes_factor: combination.log_bayes_factor,
                    cost: cost * (combination.effects.len() as f64 - 1.0),
                });
            }
        }
        Self(led)
    }

    fn led_by(&self, effect: usize) -> &[LedCombination<'a>] {
        self.0.get(&effect).map_or(&[], Vec::as_slice)
    }

    /// Returns the set of a model; `None` if the model is unknown.
    fn set(&self, ranking: &EffectRanking, model: &ModelProbability) -> Option<WeighedSet> {
        let effect = ranking.effects.get(model.explanation)?;
        let (effects, log_bayes_factor) = match (model.combination, effect.candidate) {
            (None, candidate) => (candidate.into_iter().collect(), effect.log_bayes_factor),
            (Some(place), Some(k)) => {
                let combination = self.led_by(k).get(place)?;
                (combination.effects.to_vec(), combination.log_bayes_factor)
            }
            (Some(_), None) => return None,
        };
        Some(WeighedSet {
            effects: Some(effects),
            log_bayes_factor,
            prior: model.prior,
            probability: model.posterior,
            predictive: None,
        })
    }
}

/// Returns the set of a law outside the library, if it was searched.
fn outside_set(outside: Option<f64>, probabilities: &Probabilities) -> Option<WeighedSet> {
    Some(WeighedSet {
        effects: None,
        log_bayes_factor: outside?,
        prior: probabilities.outside_prior?,
        probability: probabilities.outside?,
        predictive: None,
    })
}

impl Weighing {
    /// Computes all probabilities. A combination counts for its leading effect; each further effect has the prior 1 / number of
    /// candidates.
    pub(super) fn new(task: &SearchTask, hypotheses: &Hypotheses) -> Self {
        let mut ranking = updated_ranking(task, hypotheses);
        let cost = libm::log(task.library.len().max(1) as f64);
        let misfit = hypotheses.misfit(&task.likelihood);
        let inclusion = inclusion(hypotheses, cost, misfit);
        let led = LedCombinations::new(hypotheses, &ranking, &inclusion, cost);
        let outside = hypotheses.laws.as_ref();
        let outside = outside.map(|scan| scan.log_bayes_factor(task.laws.len()));
        let weights = |k: usize| {
            let combinations = led.led_by(k).iter();
            combinations.map(|c| (c.log_bayes_factor, c.cost)).collect()
        };
        let probabilities = ranking.weigh(weights, outside, misfit);
        let models = probabilities.models.iter();
        let mut sets: Vec<WeighedSet> = models.filter_map(|model| led.set(&ranking, model)).collect();
        sets.extend(outside_set(outside, &probabilities));
        for set in &mut sets {
            let mut predictive = hypotheses.predictive.iter();
            set.predictive = predictive
                .find(|(effects, _)| set.effects.as_ref() == Some(effects))
                .map(|(_, gain)| *gain);
        }
        sets.sort_by(|a, b| {
            let by_factor = b.log_bayes_factor.total_cmp(&a.log_bayes_factor);
            b.probability.total_cmp(&a.probability).then(by_factor)
        });
        Self {
            ranking,
            not_in_library: outside.zip(probabilities.outside),
            sets,
            misfit,
            inclusion,
        }
    }

    /// Returns the sets of effects that may explain the data, by falling probability; none without a detection.
    pub(super) fn leading<'a>(&self, hypotheses: &'a Hypotheses) -> Vec<&'a EffectCombination> {
        if hypotheses.detected().is_none() {
            return Vec::new();
        }
        let effects = self.sets.iter().filter(|set| set.probability > LEADING);
        let effects = effects
            .filter_map(|set| set.effects.as_ref())
            .filter(|e| !e.is_empty());
        let combinations = effects.filter_map(|effects| hypotheses.combination(effects));
        combinations.take(MAX_LEADING).collect()
    }

    /// Returns the effect to begin with, if several sets remain and evidence and prediction agree on the best: every rival
    /// predicts left-out levels worse by a detectable amount.
    pub(super) fn agreed(&self) -> Option<usize> {
        let best = self.sets.first()?;
        let (effects, best_gain) = (best.effects.as_ref()?, best.predictive?);
        let rivals = self.sets.iter().skip(1);
        let mut predicted = rivals.filter_map(|rival| rival.predictive).peekable();
        predicted.peek()?;
        let is_beaten = |gain: f64| (best_gain - gain) / self.misfit > DETECTED;
        let unpredicted_are_improbable = self
            .sets
            .iter()
            .filter(|set| set.predictive.is_none())
            .all(|set| set.probability < LEADING);
        let leader = leader(&self.ranking, &self.inclusion, effects);
        leader.filter(|_| predicted.all(is_beaten) && unpredicted_are_improbable)
    }

    /// Returns the sets that count for an effect, by falling probability.
    fn led_by(&self, effect: usize) -> impl Iterator<Item = &[usize]> {
        let sets = self.sets.iter().filter_map(|set| set.effects.as_deref());
        sets.filter(move |effects| leader(&self.ranking, &self.inclusion, effects) == Some(effect))
    }

    /// Returns the probability of the sets that contain both this law and effects.
    pub(super) fn beside_effects(&self, task: &SearchTask, law: usize) -> f64 {
        let is_law = |k: &usize| *k == task.curve(law) || task.forms(law).contains(k);
        let has_law = |set: &&WeighedSet| set.effects.as_ref().is_some_and(|k| k.iter().any(is_law));
        self.sets.iter().filter(has_law).map(|set| set.probability).sum()
    }

    /// Returns whether a set without an effect predicts left-out levels better, by a detectable amount, than every set with it.
    pub(super) fn is_disputed(&self, effect: usize) -> bool {
        disputes(&self.sets, effect, self.misfit)
    }

    /// Returns the explanations that further runs should distinguish; none without a detection.
    pub(super) fn open<'a>(&self, hypotheses: &'a Hypotheses) -> Vec<OpenHypothesis<'a>> {
        let (Some(base), Some(_)) = (hypotheses.base_fit(), hypotheses.detected()) else {
            return Vec::new();
        };
        let effects = self.ranking.effects.iter().filter(|e| e.probability > OPEN);
        let open = effects.filter_map(|effect| match effect.candidate {
            None => Some(OpenHypothesis {
                effects: Vec::new(),
                probability: effect.probability,
                fit: base,
            }),
            // An effect's probability is the sum over the sets that it leads; the most probable of them represents it.
            Some(k) => {
                let set = self
                    .led_by(k)
                    .find_map(|effects| hypotheses.combination(effects))?;
                Some(OpenHypothesis {
                    effects: set.effects.clone(),
                    probability: effect.probability,
                    fit: &set.fit,
                })
            }
        });
        let mut open: Vec<OpenHypothesis> = open.collect();
        let outside = self.not_in_library.filter(|(_, p)| *p > OPEN);
        if let (Some(law), Some((_, probability))) = (hypotheses.confirmed_law(), outside) {
            open.push(OpenHypothesis {
                effects: vec![law.candidate],
                probability,
                fit: &law.fit,
            });
        }
        open.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        open.truncate(MAX_OPEN);
        open
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(effects: &[usize], predictive: Option<f64>) -> WeighedSet {
        WeighedSet {
            effects: Some(effects.to_vec()),
            log_bayes_factor: 0.0,
            prior: 0.0,
            probability: 0.0,
            predictive,
        }
    }

    fn ranked(candidate: usize, log_bayes_factor: f64) -> RankedEffect {
        RankedEffect {
            candidate: Some(candidate),
            log_bayes_factor,
            stated_log_bayes_factor: log_bayes_factor,
            screen_log_bayes_factor: log_bayes_factor,
            log_likelihood: 0.0,
            prior_sds: 0.0,
            method: EvidenceMethod::Confirmed,
            probability: 0.0,
            class: candidate,
            is_credible: false,
            theta: Vec::new(),
            predicted: Vec::new(),
            at_bound: Vec::new(),
            evaluations: 0,
        }
    }

    #[test]
    fn what_most_combinations_include_leads_them() {
        let ranking = EffectRanking {
            effects: vec![ranked(1, 9.0), ranked(2, 11.0), ranked(3, 4.0)],
            ..EffectRanking::default()
        };
        // The third has a little more weight than the first, as poor combinations add.
        let inclusion = BTreeMap::from([(1, 30.0), (2, 29.9), (3, 30.0 + 1e-6)]);
        assert_eq!(leader(&ranking, &inclusion, &[1, 2]), Some(1));
        assert_eq!(leader(&ranking, &inclusion, &[3, 1]), Some(1));
        assert_eq!(leader(&ranking, &inclusion, &[1, 3]), Some(1));
        assert_eq!(leader(&ranking, &inclusion, &[3, 2]), Some(3));
        assert_eq!(leader(&ranking, &inclusion, &[7]), None);
    }

    #[test]
    fn a_better_prediction_disputes_the_effects_that_it_lacks_alone() {
        let sets = [
            set(&[1, 2], Some(10.0)),
            set(&[1, 3], Some(20.0)),
            set(&[4], Some(12.0)),
            set(&[5], None),
        ];
        assert!(!disputes(&sets, 1, 1.0));
        assert!(disputes(&sets, 2, 1.0));
        assert!(!disputes(&sets, 3, 1.0));
        assert!(disputes(&sets, 4, 1.0));
        // A misfit reduces the difference; an effect without a prediction is not disputed.
        assert!(!disputes(&sets, 4, 4.0) && !disputes(&sets, 5, 1.0));
    }
}
