//! The result of a search for one effect: the base and every candidate, with evidence and probability.

use crate::probability::{Explanation, OutsideEvidence, Probabilities};

/// How the evidence was computed, from the least to the most accurate method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum EvidenceMethod {
    /// Linear in the strength, by a finite step from the fitted base.
    Screen,
    /// Laplace's approximation at a fit with Broyden's Jacobian.
    RankOne,
    /// Laplace's approximation at a fit with a finite-difference Jacobian.
    Refined,
    /// Laplace's approximation at the best of fits from several starts.
    Confirmed,
    /// Importance sampling about that fit.
    Sampled,
}

/// The result for one model: the base, or the base with one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct RankedEffect {
    /// The effect; `None`: nothing is missing.
    pub candidate: Option<usize>,
    /// Log evidence over that of the base, with the widened priors of the strengths.
    pub log_bayes_factor: f64,
    /// Log Bayes factor with the stated priors of the strengths.
    pub stated_log_bayes_factor: f64,
    /// Log Bayes factor of the screen, with widened priors.
    pub screen_log_bayes_factor: f64,
    /// ln p(data | theta) at the most probable parameters.
    pub log_likelihood: f64,
    /// The largest distance of a strength from the middle of its prior, in standard deviations of that prior.
    pub prior_sds: f64,
    /// Method by which the evidence was computed.
    pub method: EvidenceMethod,
    /// Posterior probability; in a whole search, with that of the combinations that count for the effect.
    pub probability: f64,
    /// Number of the class, in which the data cannot distinguish effects; 0 is the base.
    pub class: usize,
    /// Whether its class belongs to the smallest set of classes with 95 % probability.
    pub is_credible: bool,
    /// The most probable parameters, the base's first.
    pub theta: Vec<f64>,
    /// Predicted values of the data there; for an effect that was only screened, those of the model linear about the base's fit.
    pub predicted: Vec<f64>,
    /// Whether each parameter lies at a bound, or at the value at which a one-sided strength is absent.
    pub at_bound: Vec<bool>,
    /// Evaluations spent on this effect alone.
    pub evaluations: usize,
}

/// Evaluations by purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EvaluationCounts {
    /// Evaluations of the base's fits, and of the measurement of its noise.
    pub base: usize,
    /// Evaluations of the screen.
    pub screen: usize,
    /// Evaluations of all extensions.
    pub extension: usize,
    /// Evaluations of the refinement.
    pub refinement: usize,
    /// Evaluations of the confirmation, importance sampling included.
    pub confirmation: usize,
}

impl EvaluationCounts {
    /// Returns the number of evaluations up to the refinement, which names the effect.
    #[must_use]
    pub fn to_name(&self) -> usize {
        self.base + self.screen + self.extension + self.refinement
    }

    /// Returns the number of evaluations up to the confirmation.
    #[must_use]
    pub fn to_confirm(&self) -> usize {
        self.to_name() + self.confirmation
    }
}

/// The base model and every candidate with their probabilities.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EffectRanking {
    /// The base first, then the candidates that the model accepted, in their order.
    pub effects: Vec<RankedEffect>,
    /// Candidates whose usual strength the base would absorb: the data can neither show nor exclude them.
    pub cannot_exclude: Vec<usize>,
    /// Candidates that the model rejected at every strength, or from all starts of a fit; they have no evidence.
    pub refused: Vec<usize>,
    /// Evaluations by purpose.
    pub evaluations: EvaluationCounts,
}

impl EffectRanking {
    /// Sets the probabilities and the credible set.
    ///
    /// # Arguments
    /// - `combinations`: log Bayes factor and log prior cost of the combinations that count for a candidate. `outside`: evidence
    ///   for a law outside the library; `None`: not searched. `none`, `misfit`: see [`Probabilities::new`].
    pub(crate) fn weigh(
        &mut self,
        combinations: impl Fn(usize) -> Vec<(f64, f64)>,
        outside: Option<&OutsideEvidence>,
        none: f64,
        misfit: f64,
    ) -> Probabilities {
        let explanation = |effect: &RankedEffect| Explanation {
            class: effect.class,
            log_bayes_factor: effect.log_bayes_factor,
            combinations: effect.candidate.map_or(Vec::new(), &combinations),
        };
        let explanations: Vec<Explanation> = self.effects.iter().map(explanation).collect();
        let probabilities = Probabilities::new(&explanations, outside, none, misfit);
        for (effect, &probability) in self.effects.iter_mut().zip(&probabilities.explanations) {
            effect.probability = probability;
            effect.is_credible = probabilities.credible.contains(&Some(effect.class));
        }
        probabilities
    }

    /// Returns the probability of a class.
    #[must_use]
    pub fn class_probability(&self, class: usize) -> f64 {
        let members = self.effects.iter().filter(|e| e.class == class);
        members.map(|e| e.probability).sum()
    }

    /// Returns the most probable candidate of a class.
    pub(crate) fn leader_of(&self, class: usize) -> Option<usize> {
        let members = self.effects.iter().filter(|e| e.class == class);
        let leader = members.max_by(|a, b| a.probability.total_cmp(&b.probability))?;
        leader.candidate
    }

    /// Returns whether a candidate belongs to a class.
    pub(crate) fn is_in_class(&self, candidate: usize, class: usize) -> bool {
        self.effect(Some(candidate))
            .is_some_and(|effect| effect.class == class)
    }

    /// Returns the result for a candidate.
    #[must_use]
    pub fn effect(&self, candidate: Option<usize>) -> Option<&RankedEffect> {
        self.effects.iter().find(|e| e.candidate == candidate)
    }

    /// Returns the candidates by falling Bayes factor.
    #[must_use]
    pub fn ranked(&self) -> Vec<&RankedEffect> {
        let mut ranked: Vec<&RankedEffect> = self.effects.iter().filter(|e| e.candidate.is_some()).collect();
        ranked.sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
        ranked
    }
}
