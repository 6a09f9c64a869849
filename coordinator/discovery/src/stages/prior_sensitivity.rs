//! Probabilities under other priors: a name that rests on the width of a prior, or on the odds that something is missing, is weak.

use crate::probability::PRIOR_OF_NONE;
use crate::stages::hypotheses::Hypotheses;
use crate::stages::weighing::Weighing;
use crate::task::SearchTask;
use statistics::likelihood::Likelihood;

/// Factors on the widths of all strengths' priors.
const WIDTHS: [f64; 2] = [0.5, 2.0];
/// Prior probabilities that nothing is missing.
const NONE: [f64; 2] = [0.2, 0.8];

/// The probabilities of all explanations under another prior.
#[derive(Debug, Clone, PartialEq)]
pub struct AlternativePrior {
    /// Probability of each candidate that is an explanation; `None`: nothing is missing.
    pub effects: Vec<(Option<usize>, f64)>,
    /// Probability of a law outside the library; `None`: not searched.
    pub not_in_library: Option<f64>,
}

/// Weighs all explanations with the priors of the strengths half and twice as wide, then with lower and higher odds that nothing is
/// missing.
///
/// # Arguments
/// - `misfit`: chi-square of the best explanation over its degrees of freedom.
///
/// # Source
/// Kallioinen et al. 2024, doi:10.1007/s11222-023-10366-5, scale priors by a power for the same purpose. Checked by
/// `search::a_name_is_weighed_under_other_priors`.
pub(super) fn alternative_priors(
    task: &SearchTask,
    hypotheses: &Hypotheses,
    misfit: f64,
) -> Vec<AlternativePrior> {
    let alternative = |hypotheses: &Hypotheses, none: f64| {
        let weighing = Weighing::with_prior(task, hypotheses, none, misfit);
        let effects = weighing.ranking.effects.iter();
        AlternativePrior {
            effects: effects
                .map(|effect| (effect.candidate, effect.probability))
                .collect(),
            not_in_library: weighing.not_in_library.map(|(_, probability)| probability),
        }
    };
    let by_width = WIDTHS.map(|width| {
        let scaled = with_width(hypotheses, &task.likelihood, width);
        alternative(&scaled, PRIOR_OF_NONE)
    });
    let by_odds = NONE.map(|none| alternative(hypotheses, none));
    by_width.into_iter().chain(by_odds).collect()
}

/// Returns the hypotheses with the widths of all strengths' priors multiplied by a factor. A fit without a positive definite Hessian keeps its
/// evidence.
fn with_width(hypotheses: &Hypotheses, likelihood: &Likelihood, width: f64) -> Hypotheses {
    let mut scaled = hypotheses.clone();
    for combination in &mut scaled.combinations {
        let gain = combination.fit.gain_by_width(likelihood, width).unwrap_or(0.0);
        combination.log_bayes_factor += gain;
        if let [k] = combination.effects.as_slice() {
            let mut ranked = scaled.ranking.effects.iter_mut();
            if let Some(effect) = ranked.find(|effect| effect.candidate == Some(*k)) {
                effect.log_bayes_factor += gain;
            }
        }
    }
    for law in scaled.laws.iter_mut().flat_map(|scan| &mut scan.laws) {
        let gain = law.fit.gain_by_width(likelihood, width).unwrap_or(0.0);
        law.log_bayes_factor += gain;
        law.mean_log_bayes_factor += gain;
    }
    scaled
}
