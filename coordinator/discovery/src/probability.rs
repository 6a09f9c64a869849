//! Probabilities of the explanations, and the thresholds of what is claimed.

use crate::laplace::evidence::log_sum_exp;

/// A log Bayes factor above this is a detection; an effect of the model that gains less may be dropped \[nats\].
pub const DETECTED: f64 = 3.0;
/// Prior probability that nothing is missing.
pub(crate) const PRIOR_OF_NONE: f64 = 0.5;
const CREDIBLE: f64 = 0.95;
/// Share of a gain of log evidence that counts in a probability.
///
/// The evidences are those of the models that were fitted, by approximations, with a noise that is declared. What acts may be none of
/// these models, and then their evidences differ by more than the data can tell. With half, stated probabilities agree with the frequency
/// of right explanations in the benchmark of 600 campaigns, a third of them with physics outside the catalogue.
///
/// # Source
/// The likelihood to a power below 1 of Miller & Dunson 2019, doi:10.1080/01621459.2018.1469995. Checked by
/// `cargo bench -p benchmark --bench hidden_effect -- calibration`.
const COUNTED_GAIN: f64 = 0.5;

/// Returns the log weight of the evidence for a model over the base: a gain counts by its share, a loss in full. Prior costs are no evidence
/// and count in full.
///
/// # Arguments
/// - `log_bayes_factor`: log evidence of the fitted model over that of the base, without prior costs.
/// - `misfit`: chi-square of the best explanation over its degrees of freedom, by which the log Bayes factor is divided.
pub(crate) fn counted_evidence(log_bayes_factor: f64, misfit: f64) -> f64 {
    let log_bayes_factor = log_bayes_factor / misfit;
    if log_bayes_factor > 0.0 {
        COUNTED_GAIN * log_bayes_factor
    } else {
        log_bayes_factor
    }
}

/// The evidence for one explanation: nothing is missing, or one effect is.
#[derive(Debug)]
pub(crate) struct Explanation {
    /// Number of the class, in which the data cannot distinguish effects; 0: nothing is missing.
    pub(crate) class: usize,
    /// Log evidence over that of the base.
    pub(crate) log_bayes_factor: f64,
    /// Log Bayes factor, without prior costs, and log prior cost of each combination of effects that counts for this explanation.
    pub(crate) combinations: Vec<(f64, f64)>,
}

/// The evidence for a law outside the library.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OutsideEvidence {
    /// Number of all laws.
    pub(crate) laws: usize,
    /// Log of the mean weight of all laws: of the counted evidence of each, less its costs.
    pub(crate) log_weight: f64,
    /// Log Bayes factor, without prior costs, and log prior cost of each combination that counts for the law.
    pub(crate) combinations: Vec<(f64, f64)>,
}

/// One model: an explanation alone, or one of the combinations that count for it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ModelProbability {
    /// Index of the explanation; `None`: the law outside the library.
    pub(crate) explanation: Option<usize>,
    /// Index among the combinations of the explanation; `None`: the explanation alone.
    pub(crate) combination: Option<usize>,
    pub(crate) prior: f64,
    pub(crate) posterior: f64,
}

/// Log prior and log weight of each model of an explanation: the explanation alone, then its combinations.
type LogWeights = Vec<(f64, f64)>;

/// Posterior probabilities.
#[derive(Debug)]
pub(crate) struct Probabilities {
    /// Probability of each explanation, the sum over its models.
    pub(crate) explanations: Vec<f64>,
    pub(crate) models: Vec<ModelProbability>,
    /// Log of the sum of all weights: priors times counted evidence.
    pub(crate) log_total: f64,
    /// Posterior probability of a law outside the library; `None`: not searched.
    pub(crate) outside: Option<f64>,
    /// The smallest set of classes with 95 % probability, the most probable first; `None` in it is the law outside the library.
    pub(crate) credible: Vec<Option<usize>>,
}

impl Probabilities {
    /// The prior is that of `none` for nothing missing. Of the rest, laws outside the library have the share of their number among all effects
    /// and laws; the classes share the remainder equally, and the members of a class theirs.
    ///
    /// # Arguments
    /// - `outside`: evidence for a law outside the library; `None`: not searched.
    /// - `none`: prior probability that nothing is missing.
    /// - `misfit`: chi-square of the best explanation over its degrees of freedom, 1 where it fits. Log Bayes factors are divided by it,
    ///   as if the noise were larger by its root: where every explanation is wrong, differences between them mean less.
    ///
    /// A gain of evidence counts by a share ([`counted_evidence`]).
    ///
    /// # Source
    /// Kass & Raftery 1995, section 5.3, doi:10.1080/01621459.1995.10476572. Checked by
    /// `effect_search::probabilities_sum_to_one_and_follow_the_prior_over_classes`.
    pub(crate) fn new(
        explanations: &[Explanation],
        outside: Option<&OutsideEvidence>,
        none: f64,
        misfit: f64,
    ) -> Self {
        let classes = explanations.iter().map(|e| e.class).max().unwrap_or(0);
        let effects = explanations.iter().filter(|e| e.class > 0).count();
        let of_law = outside.map_or(0.0, |law| {
            let laws = law.laws.max(1) as f64;
            (1.0 - none) * laws / (laws + effects as f64)
        });
        let members = |class: usize| explanations.iter().filter(|e| e.class == class).count() as f64;
        let prior = |class: usize| match class {
            // Without an alternative nothing can be missing.
            0 if classes == 0 && outside.is_none() => 1.0,
            0 => none,
            class => (1.0 - none - of_law) / classes as f64 / members(class),
        };
        // Log prior and log weight of the explanation alone, then of its combinations.
        let models = |prior: f64, alone: f64, combinations: &[(f64, f64)]| -> LogWeights {
            let log_prior = libm::log(prior);
            let alone = (log_prior, log_prior + alone);
            let combinations = combinations.iter().map(|(factor, cost)| {
                let log_prior = log_prior - cost;
                (log_prior, log_prior + counted_evidence(*factor, misfit))
            });
            std::iter::once(alone).chain(combinations).collect()
        };
        let of_explanation = |e: &Explanation| {
            let alone = counted_evidence(e.log_bayes_factor, misfit);
            models(prior(e.class), alone, &e.combinations)
        };
        let mut weighed: Vec<(Option<usize>, LogWeights)> = explanations
            .iter()
            .enumerate()
            .map(|(k, explanation)| (Some(k), of_explanation(explanation)))
            .collect();
        let weighed_law = outside.map(|law| models(of_law, law.log_weight, &law.combinations));
        weighed.extend(weighed_law.map(|models| (None, models)));
        let weight = |models: &[(f64, f64)]| log_sum_exp(models.iter().map(|(_, weight)| *weight));
        let weights: Vec<f64> = weighed.iter().map(|(_, models)| weight(models)).collect();
        let sum = log_sum_exp(weights.iter().copied());
        let mut each_probability: Vec<f64> = weights.iter().map(|w| libm::exp(w - sum)).collect();
        let models = weighed.iter().flat_map(|(explanation, models)| {
            let places = models.iter().enumerate();
            places.map(move |(place, (log_prior, weight))| ModelProbability {
                explanation: *explanation,
                combination: place.checked_sub(1),
                prior: libm::exp(*log_prior),
                posterior: libm::exp(weight - sum),
            })
        });
        let models = models.collect();
        let outside = outside.and_then(|_| each_probability.pop());
        let class_probability = |class: usize| -> f64 {
            let members = explanations.iter().zip(&each_probability);
            members.filter(|(e, _)| e.class == class).map(|(_, p)| p).sum()
        };
        let mut by_class: Vec<(Option<usize>, f64)> = (0..=classes)
            .map(|class| (Some(class), class_probability(class)))
            .collect();
        by_class.extend(outside.map(|p| (None, p)));
        Self {
            credible: credible(by_class),
            explanations: each_probability,
            models,
            log_total: sum,
            outside,
        }
    }
}

/// Returns the smallest set of classes with 95 % probability, from the probability of each class.
fn credible(mut by_class: Vec<(Option<usize>, f64)>) -> Vec<Option<usize>> {
    by_class.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut sum = 0.0;
    let credible = by_class.into_iter().take_while(|(_, probability)| {
        let is_open = sum < CREDIBLE;
        sum += probability;
        is_open
    });
    credible.map(|(class, _)| class).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explanation(class: usize, log_bayes_factor: f64) -> Explanation {
        Explanation {
            class,
            log_bayes_factor,
            combinations: Vec::new(),
        }
    }

    fn law(log_weight: f64) -> OutsideEvidence {
        OutsideEvidence {
            laws: 1,
            log_weight,
            combinations: Vec::new(),
        }
    }

    #[test]
    fn the_log_sum_of_one_term_is_the_term_to_the_last_bit() {
        for x in [
            -745.3,
            -1.0 / 3.0,
            0.0,
            1e-300,
            0.1,
            std::f64::consts::LN_2,
            1234.5678,
        ] {
            assert_eq!(log_sum_exp(std::iter::once(x)).to_bits(), x.to_bits());
        }
    }

    #[test]
    fn without_combinations_a_probability_is_prior_times_bayes_factor() {
        let all = [
            explanation(0, 0.0),
            explanation(1, 1.7),
            explanation(1, 0.3),
            explanation(2, -2.1),
        ];
        let log_priors = [0.5, 0.5 / 2.0 / 2.0, 0.5 / 2.0 / 2.0, 0.5 / 2.0 / 1.0].map(libm::log);
        let weights: Vec<f64> = all
            .iter()
            .zip(log_priors)
            .map(|(e, p)| p + counted_evidence(e.log_bayes_factor, 1.0))
            .collect();
        let sum = log_sum_exp(weights.iter().copied());
        let expected: Vec<u64> = weights.iter().map(|w| libm::exp(w - sum).to_bits()).collect();
        let probabilities = Probabilities::new(&all, None, PRIOR_OF_NONE, 1.0);
        let computed: Vec<u64> = probabilities.explanations.iter().map(|p| p.to_bits()).collect();
        assert_eq!(computed, expected);
    }

    #[test]
    fn the_credible_set_is_the_smallest_with_its_probability() {
        let all = [
            explanation(0, 0.0),
            explanation(1, 6.0),
            explanation(2, 4.0),
            explanation(3, -9.0),
        ];
        let probabilities = Probabilities::new(&all, Some(&law(4.0)), PRIOR_OF_NONE, 1.0);
        assert_eq!(probabilities.credible, [None, Some(1), Some(2)]);
        let total = probabilities.explanations.iter().sum::<f64>() + probabilities.outside.unwrap();
        assert!((total - 1.0).abs() < 1e-12);
    }

    #[test]
    fn without_an_alternative_nothing_is_missing() {
        assert_eq!(
            Probabilities::new(&[explanation(0, 0.0)], None, PRIOR_OF_NONE, 1.0).explanations,
            [1.0]
        );
    }

    #[test]
    fn a_misfit_brings_explanations_closer() {
        let all = [explanation(0, 0.0), explanation(1, 12.0), explanation(2, 4.0)];
        let odds = |misfit: f64| {
            let p = Probabilities::new(&all, None, PRIOR_OF_NONE, misfit).explanations;
            libm::log(p[1] / p[2])
        };
        let counted = |nats: f64| COUNTED_GAIN * nats;
        assert!((odds(1.0) - counted(8.0)).abs() < 1e-9 && (odds(4.0) - counted(2.0)).abs() < 1e-9);
    }

    #[test]
    fn the_models_of_an_explanation_share_its_probability() {
        let mut all = [explanation(0, 0.0), explanation(1, 3.0)];
        all[1].combinations = vec![(9.0, 3.5), (2.0, 3.5)];
        let probabilities = Probabilities::new(&all, Some(&law(1.0)), PRIOR_OF_NONE, 1.0);
        let models = probabilities.models.iter().filter(|m| m.explanation == Some(1));
        let sum: f64 = models.clone().map(|m| m.posterior).sum();
        assert!((sum - probabilities.explanations[1]).abs() < 1e-12);
        let places: Vec<Option<usize>> = models.map(|m| m.combination).collect();
        assert_eq!(places, [None, Some(0), Some(1)]);
        // The printed priors and Bayes factors give the printed odds.
        let models = &probabilities.models;
        let odds = models[2].posterior / models[0].posterior;
        let expected = models[2].prior / models[0].prior * libm::exp(COUNTED_GAIN * 9.0);
        assert!((odds / expected - 1.0).abs() < 1e-12);
    }
}
