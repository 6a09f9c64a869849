//! Say which effect is missing, how probably, and what the data cannot say.

use crate::evidence::log_sum_exp;

/// Prior probability that nothing is missing.
const PRIOR_OF_NONE: f64 = 0.5;
/// Probability that the credible set holds.
const CREDIBLE: f64 = 0.95;

/// How a Bayes factor was computed, from the roughest to the most thorough.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Linear in the strength, by a finite step from the fitted base.
    Screen,
    /// Laplace at a fit that learnt its derivatives from its own steps.
    RankOne,
    /// Laplace at a fit with derivatives of its own.
    Polished,
    /// Laplace at the best of fits from several starts.
    Confirmed,
    /// Importance sampling around that fit.
    Sampled,
}

/// What was found of one model: the base, or the base with an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The effect; `None`: nothing is missing.
    pub candidate: Option<usize>,
    /// ln of its evidence over that of the base.
    pub log_bayes_factor: f64,
    /// The same by the screen alone.
    pub screen_log_bayes_factor: f64,
    /// ln p(data | theta) at the most probable parameters.
    pub log_likelihood: f64,
    /// How its evidence was computed.
    pub method: Method,
    /// Its probability among all that were judged.
    pub probability: f64,
    /// Models that the data cannot tell apart have the same; that of the base is 0.
    pub class: usize,
    /// The most probable parameters, the effect's behind the base's.
    pub theta: Vec<f64>,
    /// Which of them lie at a bound; for a strength also: where the effect is absent.
    pub at_bound: Vec<bool>,
    /// Evaluations spent on it alone.
    pub evaluations: usize,
}

/// Evaluations spent, by what they were for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Spent {
    /// Fit of the base.
    pub base: usize,
    /// Screen.
    pub screen: usize,
    /// Fits of all extensions.
    pub extension: usize,
    /// Polish.
    pub polish: usize,
    /// Confirmation.
    pub confirm: usize,
}

impl Spent {
    /// Until the effect has a name.
    #[must_use]
    pub fn to_name(&self) -> usize {
        self.base + self.screen + self.extension + self.polish
    }

    /// Until that is confirmed.
    #[must_use]
    pub fn to_confirm(&self) -> usize {
        self.to_name() + self.confirm
    }
}

/// What discovery found.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The base first, then the candidates that the model took, in their order.
    pub judged: Vec<Judged>,
    /// The least set of classes that holds the truth with 95 % probability, the most probable first.
    pub credible_set: Vec<usize>,
    /// Candidates whose usual strength the base would absorb: the data cannot show them, and do not exclude them.
    pub cannot_exclude: Vec<usize>,
    /// Candidates that the model refused at every strength tried; nothing is said of them.
    pub refused: Vec<usize>,
    /// Evaluations spent.
    pub spent: Spent,
}

impl Finding {
    /// Gives every model its probability: prior 1/2 for nothing missing, the rest equal over classes and, within a class, over
    /// its members.
    ///
    /// Checked by `discovery::probabilities_sum_to_one`.
    pub(crate) fn weigh(mut self) -> Self {
        let classes = self.judged.iter().map(|j| j.class).max().unwrap_or(0);
        let size = |class: usize| self.judged.iter().filter(|j| j.class == class).count() as f64;
        let prior = |judged: &Judged| match judged.class {
            // Without a candidate nothing can be missing.
            0 if classes == 0 => 1.0,
            0 => PRIOR_OF_NONE,
            class => (1.0 - PRIOR_OF_NONE) / classes as f64 / size(class),
        };
        let weights: Vec<f64> = self
            .judged
            .iter()
            .map(|j| libm::log(prior(j)) + j.log_bayes_factor)
            .collect();
        let sum = log_sum_exp(weights.iter().copied());
        for (judged, weight) in self.judged.iter_mut().zip(weights) {
            judged.probability = libm::exp(weight - sum);
        }
        let mut by_class: Vec<(usize, f64)> = (0..=classes).map(|c| (c, self.of_class(c))).collect();
        by_class.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut held = 0.0;
        for (class, probability) in by_class {
            if held >= CREDIBLE {
                break;
            }
            held += probability;
            self.credible_set.push(class);
        }
        self
    }

    /// Probability of a class.
    #[must_use]
    pub fn of_class(&self, class: usize) -> f64 {
        let members = self.judged.iter().filter(|j| j.class == class);
        members.map(|j| j.probability).sum()
    }

    /// What was found of a candidate.
    #[must_use]
    pub fn of(&self, candidate: Option<usize>) -> Option<&Judged> {
        self.judged.iter().find(|j| j.candidate == candidate)
    }

    /// The candidates by falling Bayes factor.
    #[must_use]
    pub fn ranked(&self) -> Vec<&Judged> {
        let mut ranked: Vec<&Judged> = self.judged.iter().filter(|j| j.candidate.is_some()).collect();
        ranked.sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
        ranked
    }
}
