//! The probabilities of all hypotheses.

use std::collections::BTreeMap;

use crate::effect_search::ranking::EffectRanking;
use crate::laplace::evidence::log_sum_exp;
use crate::search::hypotheses::Hypotheses;
use crate::search::next_run::OpenHypothesis;
use crate::task::SearchTask;

/// Explanations with less probability are not compared by further runs.
const OPEN: f64 = 0.02;
/// Most explanations that further runs compare.
const MOST_OPEN: usize = 5;

/// The single effects with their probabilities, and those of everything else.
pub(super) struct Weighing {
    pub(super) ranking: EffectRanking,
    /// Log Bayes factor and probability of a law outside the library; `None`: not searched.
    pub(super) not_in_library: Option<(f64, f64)>,
}

impl Weighing {
    /// A combination counts for its member with the highest Bayes factor; each further effect has the prior of one among all.
    pub(super) fn new(task: &SearchTask, hypotheses: &Hypotheses) -> Self {
        let mut ranking = hypotheses.ranking.clone();
        // The backward elimination may have found a better fit of a single effect.
        for effect in &mut ranking.effects {
            let single = effect.candidate.and_then(|k| hypotheses.single(k));
            if let Some(single) = single.filter(|s| s.log_bayes_factor > effect.log_bayes_factor) {
                effect.log_bayes_factor = single.log_bayes_factor;
                effect.log_likelihood = single.fit.point.log_likelihood(&single.fit.frame);
                effect.prior_sds = single.fit.frame.strength_distance(&single.fit.point.position);
                effect.theta = single.fit.theta();
                effect.at_bound = single.fit.frame.at_bound(&single.fit.point.position);
            }
        }
        let factor = |k: usize| {
            ranking
                .of(Some(k))
                .map_or(f64::NEG_INFINITY, |e| e.log_bayes_factor)
        };
        let further = libm::log(task.library.len().max(1) as f64);
        let mut led: BTreeMap<usize, Vec<(f64, f64)>> = BTreeMap::new();
        for combination in hypotheses.combinations.iter().filter(|c| c.effects.len() > 1) {
            let members = combination.effects.iter().copied();
            let leader = members.reduce(|a, b| if factor(b) > factor(a) { b } else { a });
            let cost = further * (combination.effects.len() as f64 - 1.0);
            if let Some(leader) = leader {
                let own = led.entry(leader).or_default();
                own.push((combination.log_bayes_factor, cost));
            }
        }
        // The law is one of all that could be fitted; those that were not count without evidence.
        let outside = hypotheses.laws.as_ref().map(|laws| {
            let means = laws.iter().map(|law| law.mean_log_bayes_factor);
            log_sum_exp(means) - libm::log(task.laws.len().max(1) as f64)
        });
        let probability = ranking.weigh(|k| led.get(&k).cloned().unwrap_or_default(), outside);
        Self {
            ranking,
            not_in_library: outside.zip(probability),
        }
    }

    /// The explanations that further runs should distinguish; none without a detection.
    pub(super) fn open<'a>(&self, hypotheses: &'a Hypotheses) -> Vec<OpenHypothesis<'a>> {
        let (Some(base), Some(_)) = (hypotheses.base_fit(), hypotheses.detected()) else {
            return Vec::new();
        };
        let effects = self.ranking.effects.iter().filter(|e| e.probability > OPEN);
        let open = effects.filter_map(|effect| {
            Some(OpenHypothesis {
                effects: effect.candidate.into_iter().collect(),
                probability: effect.probability,
                fit: match effect.candidate {
                    None => base,
                    Some(k) => &hypotheses.single(k)?.fit,
                },
            })
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
        open.truncate(MOST_OPEN);
        open
    }
}
