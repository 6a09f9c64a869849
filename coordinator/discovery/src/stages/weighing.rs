//! The probabilities of all hypotheses, from which predictions, next runs and verdict follow (steps 12 and 13).

use std::collections::BTreeMap;

use crate::effect_search::ranking::{EffectRanking, EvidenceMethod};
use crate::laplace::evidence::log_sum_exp;
use crate::probability::{DETECTED, ModelProbability, OutsideEvidence, PRIOR_OF_NONE, counted_evidence};
use crate::settings::Smoothness;
use crate::stages::hypotheses::{EffectCombination, Hypotheses};
use crate::stages::next_run::OpenHypothesis;
use crate::task::SearchTask;

/// Further runs do not compare explanations that are less probable.
const OPEN: f64 = 0.005;
/// Maximum number of explanations that further runs compare, and that number for a rough model: an evaluation on all runs that
/// could be made costs several of the fitted runs.
const MAX_OPEN: usize = 12;
const MAX_OPEN_OF_ROUGH: usize = 4;
/// Maximum number of laws alone among them, one for each place.
const MAX_PLACES: usize = 4;
/// Less probable sets are not compared by prediction.
const LEADING: f64 = 0.01;
/// Maximum number of sets that predict left-out levels.
const MAX_LEADING: usize = 4;

/// A model that explains the data: nothing is missing, effects that act together, or a law outside the library.
#[derive(Debug, Clone, PartialEq)]
pub struct WeighedSet {
    /// The effects, empty if nothing is missing; `None` for a law outside the library.
    pub effects: Option<Vec<usize>>,
    /// Log evidence over that of the base; of a law outside the library, of the mean over all laws.
    pub log_bayes_factor: f64,
    /// Prior probability, with the cost of the choice of a law among the effects.
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
    /// Log of the sum of all weights: priors times counted evidence.
    pub(super) log_total: f64,
    inclusion: Inclusion,
    factors: FactorsOfLaw,
    /// Number of the library's effects, which come first among the candidates.
    library: usize,
}

/// A combination that counts for its leading effect.
struct LedCombination<'a> {
    effects: &'a [usize],
    /// Log evidence over that of the base, without the costs.
    log_bayes_factor: f64,
    /// Log prior cost of the members, without that of the leading effect.
    cost: f64,
}

/// The member of a set for which the set counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Leader {
    Effect(usize),
    /// A law outside the library.
    Law,
}

/// Log of the summed weights of the sets that include each effect of the library, or a law.
type Inclusion = BTreeMap<Leader, f64>;

/// The sets with a law, each with its effects that may be, with the law, one law of two variables; none without such an effect.
type FactorsOfLaw = BTreeMap<Vec<usize>, Vec<usize>>;

/// Sets whose log weight is lower than that of the best by more than this are no rivals of it \[nats\].
const NEAR: f64 = 5.0;

/// Two effects whose log inclusion weights differ by less count as equally included: such a difference depends on which poor
/// combinations were tried.
const SAME_WEIGHT: f64 = 0.01;

/// # Arguments
/// - `library`: number of the library's effects. `law`: log weight of a law alone.
fn inclusion(hypotheses: &Hypotheses, library: usize, law: Option<f64>, misfit: f64) -> Inclusion {
    let mut weights: BTreeMap<Leader, Vec<f64>> = BTreeMap::new();
    for combination in &hypotheses.combinations {
        let evidence = counted_evidence(combination.fitted_log_bayes_factor(), misfit);
        let weight = evidence - combination.prior_cost(library);
        for &k in &combination.effects {
            let member = if k < library {
                Leader::Effect(k)
            } else {
                Leader::Law
            };
            weights.entry(member).or_default().push(weight);
        }
    }
    if let Some(law) = law {
        weights.entry(Leader::Law).or_default().push(law);
    }
    let sum = |(k, weights): (Leader, Vec<f64>)| (k, log_sum_exp(weights.into_iter()));
    weights.into_iter().map(sum).collect()
}

/// What decides for which of its members a set counts.
struct Leadership<'a> {
    ranking: &'a EffectRanking,
    inclusion: &'a Inclusion,
    /// Number of the library's effects, which come first among the candidates.
    library: usize,
    /// Log Bayes factor of a law alone; `None`: not searched.
    law: Option<f64>,
    factors: &'a FactorsOfLaw,
}

impl Leadership<'_> {
    /// The member of a set with the highest inclusion weight; among equals, the one with the highest Bayes factor alone. `None`
    /// without one. An effect that all good sets have is thus not named after a rival that some have. A law with an effect of the same
    /// quantity may be one law of two variables, so such an effect does not lead.
    fn leader(&self, effects: &[usize]) -> Option<Leader> {
        let factors = self.factors.get(effects).filter(|_| self.law.is_some());
        let may_lead = |k: &&usize| factors.is_none_or(|factors| !factors.contains(*k));
        let member = |k: &usize| -> Option<(Leader, f64)> {
            if *k < self.library {
                let factor = self.ranking.effect(Some(*k))?.log_bayes_factor;
                Some((Leader::Effect(*k), factor))
            } else {
                Some((Leader::Law, self.law?))
            }
        };
        let members: Vec<(Leader, f64)> = effects.iter().filter(may_lead).filter_map(member).collect();
        let weight = |member: &Leader| self.inclusion.get(member).copied().unwrap_or(f64::NEG_INFINITY);
        let weights = members.iter().map(|(member, _)| weight(member));
        let highest = weights.fold(f64::NEG_INFINITY, f64::max);
        let best = members
            .into_iter()
            .filter(|(member, _)| weight(member) >= highest - SAME_WEIGHT);
        let best = best.reduce(|a, b| {
            let by_factor = b.1.total_cmp(&a.1);
            if by_factor.then(a.0.cmp(&b.0)).is_gt() {
                b
            } else {
                a
            }
        });
        best.map(|(member, _)| member)
    }
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

/// The combinations of two members and more, by their leader.
struct LedCombinations<'a>(BTreeMap<Leader, Vec<LedCombination<'a>>>);

impl<'a> LedCombinations<'a> {
    /// Groups the combinations by their leading member.
    fn new(hypotheses: &'a Hypotheses, leadership: &Leadership) -> Self {
        let cost_of = |leader: Leader| match leader {
            Leader::Effect(_) => libm::log(leadership.library.max(1) as f64),
            // The cost of the choice of a law is not part of the prior of all laws.
            Leader::Law => 0.0,
        };
        let mut led: BTreeMap<Leader, Vec<LedCombination>> = BTreeMap::new();
        for combination in hypotheses.combinations.iter().filter(|c| c.effects.len() > 1) {
            if let Some(leader) = leadership.leader(&combination.effects) {
                led.entry(leader).or_default().push(LedCombination {
                    effects: &combination.effects,
                    log_bayes_factor: combination.fitted_log_bayes_factor(),
                    cost: combination.prior_cost(leadership.library) - cost_of(leader),
                });
            }
        }
        Self(led)
    }

    fn led_by(&self, leader: Leader) -> &[LedCombination<'a>] {
        self.0.get(&leader).map_or(&[], Vec::as_slice)
    }

    /// Log Bayes factor, without prior costs, and log prior cost of each combination that counts for a leader.
    fn weights(&self, leader: Leader) -> Vec<(f64, f64)> {
        let led = self.led_by(leader).iter();
        led.map(|c| (c.log_bayes_factor, c.cost)).collect()
    }

    /// The set of a model; `None` if the model is unknown.
    ///
    /// # Arguments
    /// - `law`: log Bayes factor of a law alone.
    fn set(&self, ranking: &EffectRanking, law: Option<f64>, model: &ModelProbability) -> Option<WeighedSet> {
        let (leader, alone, log_bayes_factor) = match model.explanation {
            Some(place) => {
                let effect = ranking.effects.get(place)?;
                let alone: Vec<usize> = effect.candidate.into_iter().collect();
                (
                    effect.candidate.map(Leader::Effect),
                    Some(alone),
                    effect.log_bayes_factor,
                )
            }
            None => (Some(Leader::Law), None, law?),
        };
        let (effects, log_bayes_factor) = match model.combination {
            None => (alone, log_bayes_factor),
            Some(place) => {
                let combination = self.led_by(leader?).get(place)?;
                (Some(combination.effects.to_vec()), combination.log_bayes_factor)
            }
        };
        Some(WeighedSet {
            effects,
            log_bayes_factor,
            prior: model.prior,
            probability: model.posterior,
            predictive: None,
        })
    }
}

impl Weighing {
    /// Computes all probabilities. A combination counts for its leading member; each further effect has the prior 1 / number of the
    /// library's effects, and a law that of its choice.
    pub(super) fn new(task: &SearchTask, hypotheses: &Hypotheses) -> Self {
        let misfit = hypotheses.misfit(&task.likelihood);
        Self::with_prior(task, hypotheses, PRIOR_OF_NONE, misfit)
    }

    /// # Arguments
    /// - `none`: prior probability that nothing is missing. `misfit`: chi-square of the best explanation over its degrees of freedom.
    pub(super) fn with_prior(task: &SearchTask, hypotheses: &Hypotheses, none: f64, misfit: f64) -> Self {
        let mut ranking = updated_ranking(task, hypotheses);
        let library = task.library.len();
        let law = hypotheses.laws.as_ref();
        let law = law.map(|scan| scan.log_bayes_factor(task.laws.len()));
        let law_weight = hypotheses.laws.as_ref().map(|scan| {
            let weights = scan.log_weights(task.laws.len(), misfit);
            log_sum_exp(weights.map(|(_, weight)| weight))
        });
        let inclusion = inclusion(hypotheses, library, law_weight, misfit);
        let sets = hypotheses.combinations.iter().map(|set| &set.effects);
        let factors = sets.map(|set| (set.clone(), task.factors_of_law(set)));
        let factors = factors.filter(|(_, factors)| !factors.is_empty()).collect();
        let leadership = Leadership {
            ranking: &ranking,
            inclusion: &inclusion,
            library,
            law,
            factors: &factors,
        };
        let led = LedCombinations::new(hypotheses, &leadership);
        let outside = law_weight.map(|log_weight| OutsideEvidence {
            laws: task.laws.len(),
            log_weight,
            combinations: led.weights(Leader::Law),
        });
        let probabilities = ranking.weigh(|k| led.weights(Leader::Effect(k)), outside.as_ref(), none, misfit);
        let models = probabilities.models.iter();
        let mut sets: Vec<WeighedSet> = models.filter_map(|model| led.set(&ranking, law, model)).collect();
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
            not_in_library: law.zip(probabilities.outside),
            sets,
            misfit,
            log_total: probabilities.log_total,
            inclusion,
            factors,
            library,
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
        // An effect beside a law is named or not; it is never added without that law.
        if self.has_law(best) {
            return None;
        }
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
        let leader = match self.leadership().leader(effects)? {
            Leader::Effect(k) => Some(k),
            Leader::Law => None,
        };
        leader.filter(|_| predicted.all(is_beaten) && unpredicted_are_improbable)
    }

    /// Returns the sets that count for an effect, by falling probability.
    fn led_by(&self, effect: usize) -> impl Iterator<Item = &[usize]> {
        let sets = self.sets.iter().filter_map(|set| set.effects.as_deref());
        sets.filter(move |effects| self.leadership().leader(effects) == Some(Leader::Effect(effect)))
    }

    fn leadership(&self) -> Leadership<'_> {
        Leadership {
            ranking: &self.ranking,
            inclusion: &self.inclusion,
            library: self.library,
            law: self.not_in_library.map(|(factor, _)| factor),
            factors: &self.factors,
        }
    }

    /// Whether a set has a law outside the library.
    fn has_law(&self, set: &WeighedSet) -> bool {
        let effects = set.effects.as_ref();
        effects.is_none_or(|effects| effects.iter().any(|k| *k >= self.library))
    }

    /// Probability of the sets that have a law outside the library.
    pub(super) fn law_probability(&self) -> f64 {
        let with_law = self.sets.iter().filter(|set| self.has_law(set));
        with_law.map(|set| set.probability).sum()
    }

    /// The effects of the most probable set, if a law is among them.
    pub(super) fn best_with_law(&self) -> Option<&[usize]> {
        let best = self.sets.first().filter(|set| self.has_law(set))?;
        best.effects.as_deref()
    }

    /// The most probable set, and those that are not far less probable.
    fn near(&self) -> impl Iterator<Item = &WeighedSet> {
        let highest = self.sets.first().map_or(0.0, |set| set.probability);
        self.sets
            .iter()
            .filter(move |set| set.probability > highest * libm::exp(-NEAR))
    }

    /// Whether an effect may be named beside the law of the most probable set: all sets near it have the effect, and the effect was
    /// fitted with a law alone. Without a law in that set, every effect may be.
    pub(super) fn stands_beside_law(&self, is_named: impl Fn(usize) -> bool) -> bool {
        let has_effect = |set: &WeighedSet| set.effects.iter().flatten().any(|k| is_named(*k));
        let is_pair = |set: &WeighedSet| {
            set.effects.as_ref().is_some_and(|e| e.len() == 2) && self.has_law(set) && has_effect(set)
        };
        let has_law = self.sets.first().is_some_and(|set| self.has_law(set));
        !has_law || (self.near().all(has_effect) && self.sets.iter().any(is_pair))
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
        open.extend(self.open_laws(hypotheses));
        open.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        open.truncate(match base.frame.smoothness {
            Smoothness::Smooth => MAX_OPEN,
            Smoothness::Rough | Smoothness::Unknown => MAX_OPEN_OF_ROUGH,
        });
        open
    }
}

impl Weighing {
    /// Returns the laws alone and the sets that a law leads, as far as they are open. Laws alone of which none was cross-validated are
    /// none; otherwise each that may act counts by its share, so that further runs tell where the law acts.
    fn open_laws<'a>(&self, hypotheses: &'a Hypotheses) -> impl Iterator<Item = OpenHypothesis<'a>> {
        let sets = self.sets.iter().filter(|set| set.probability > OPEN);
        sets.flat_map(|set| match &set.effects {
            None => self.laws_alone(hypotheses, set.probability),
            Some(effects) if self.leadership().leader(effects) == Some(Leader::Law) => {
                let combination = hypotheses.combination(effects);
                let open = combination.map(|combination| OpenHypothesis {
                    effects: effects.clone(),
                    probability: set.probability,
                    fit: &combination.fit,
                });
                open.into_iter().collect()
            }
            Some(_) => Vec::new(),
        })
    }

    /// Returns the laws alone with the largest shares of a probability, in proportion to their weights: those that are open, and at least
    /// one; none if no law was cross-validated.
    fn laws_alone<'a>(&self, hypotheses: &'a Hypotheses, probability: f64) -> Vec<OpenHypothesis<'a>> {
        let scan = hypotheses.laws.iter().filter(|scan| scan.confirmed.is_some());
        // All laws have the same cost of choice among the possible ones.
        let laws = scan.flat_map(|scan| scan.shares(1, self.misfit));
        let open = laws.map(|(law, share)| OpenHypothesis {
            effects: vec![law.candidate],
            probability: probability * share,
            fit: &law.fit,
        });
        let mut open: Vec<OpenHypothesis> = open.collect();
        open.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        let count = open.iter().filter(|law| law.probability > OPEN).count();
        open.truncate(count.clamp(1, MAX_PLACES));
        open
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect_search::ranking::RankedEffect;

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
            effects: vec![ranked(1, 9.0), ranked(2, 11.0), ranked(3, 4.0), ranked(4, 2.0)],
            ..EffectRanking::default()
        };
        // The third has a little more weight than the first, as poor combinations add.
        let weights = [(1, 30.0), (2, 29.9), (3, 30.0 + 1e-6), (4, 31.0)];
        let mut inclusion: Inclusion = weights.map(|(k, weight)| (Leader::Effect(k), weight)).into();
        inclusion.insert(Leader::Law, 30.0);
        let leadership = Leadership {
            ranking: &ranking,
            inclusion: &inclusion,
            library: 8,
            law: Some(10.0),
            factors: &FactorsOfLaw::from([(vec![1, 10], vec![1]), (vec![1, 4, 10], vec![1])]),
        };
        let leader = |effects: &[usize]| leadership.leader(effects);
        let effect = |k: usize| Some(Leader::Effect(k));
        assert_eq!(leader(&[1, 2]), effect(1));
        assert_eq!(leader(&[3, 1]), effect(1));
        assert_eq!(leader(&[1, 3]), effect(1));
        assert_eq!(leader(&[3, 2]), effect(3));
        assert_eq!(leader(&[7]), None);
        // The law has the weight of the first, and more evidence alone.
        assert_eq!(leader(&[1, 9]), Some(Leader::Law));
        assert_eq!(leader(&[2, 9]), Some(Leader::Law));
        // An effect that leads its set otherwise yields to a law of the same quantity.
        assert_eq!(leader(&[1, 10]), Some(Leader::Law));
        // An effect of another quantity does not.
        assert_eq!(leader(&[1, 4, 10]), effect(4));
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
