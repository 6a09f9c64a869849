//! Combinations of effects and laws outside the library, found so far.

use std::collections::BTreeSet;

use crate::candidate::Candidate;
use crate::chi_square::FitChiSquare;
use crate::effect_search::ranking::EffectRanking;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::probability::DETECTED;
use statistics::likelihood::Likelihood;

/// Cost of each effect after the first \[nats\]: a bound of the gain by choosing from the library.
const COST_OF_CHOICE: f64 = 5.0;

/// The results of the stages so far.
#[derive(Debug, Clone)]
pub(super) struct Hypotheses {
    /// All candidates of the task.
    pub(super) candidates: Vec<Candidate>,
    /// The base's fit.
    pub(super) base: Option<FittedModel>,
    /// The search for one effect.
    pub(super) ranking: EffectRanking,
    /// Combinations by falling Bayes factor, single effects among them.
    pub(super) combinations: Vec<EffectCombination>,
    /// The sets of effects of one family that were fitted together.
    pub(super) of_families: BTreeSet<CandidateSet>,
    /// The sets that were fitted with an effect exchanged.
    pub(super) exchanged: BTreeSet<CandidateSet>,
    /// Log Bayes factor of the base over itself without each effect that may be dropped; `None` where that cannot be fitted.
    pub(super) gains: Vec<Option<f64>>,
    /// Laws outside the library beyond the base; `None`: not searched.
    pub(super) laws: Option<LawScan>,
    /// The same beyond the best combination, where that leaves misfit.
    pub(super) further_laws: Option<LawScan>,
    /// The leading sets with their log predictive density of left-out levels over that of the base.
    pub(super) predictive: Vec<(Vec<usize>, f64)>,
}

/// Candidates that act together, in whatever order.
pub(super) type CandidateSet = BTreeSet<usize>;

pub(super) fn candidate_set(effects: &[usize]) -> CandidateSet {
    effects.iter().copied().collect()
}

/// Effects that act together, with their fit.
#[derive(Debug, Clone)]
pub(super) struct EffectCombination {
    /// In the order in which their parameters follow the base's.
    pub(super) effects: Vec<usize>,
    /// Over the base.
    pub(super) log_bayes_factor: f64,
    pub(super) fit: LaplaceFit,
}

/// Laws outside the library, fitted beyond one model.
#[derive(Debug, Clone)]
pub(super) struct LawScan {
    /// The effects of that model beyond the base.
    pub(super) beyond: Vec<usize>,
    /// By falling Bayes factor, one for each quantity and variable.
    pub(super) laws: Vec<FittedLaw>,
    /// The law that passed the cross-validation.
    pub(super) confirmed: Option<usize>,
}

/// A fitted law outside the library.
#[derive(Debug, Clone)]
pub(super) struct FittedLaw {
    /// Index of the law in the task.
    pub(super) law: usize,
    /// Its best description: a form, or the curve.
    pub(super) candidate: usize,
    /// Over the model that was scanned.
    pub(super) log_bayes_factor: f64,
    /// Of the mean evidence of curve and forms.
    pub(super) mean_log_bayes_factor: f64,
    pub(super) fit: LaplaceFit,
    /// Log predictive density of the left-out data over that of the base and of the library's best combination.
    pub(super) left_out: Option<[f64; 2]>,
}

impl LawScan {
    /// Log Bayes factor of a law outside the library over the model that was scanned: one of all that could be fitted; those that were
    /// not count without evidence.
    pub(super) fn log_bayes_factor(&self, possible: usize) -> f64 {
        let means = self.laws.iter().map(|law| law.mean_log_bayes_factor);
        log_sum_exp(means) - libm::log(possible.max(1) as f64)
    }
}

impl Hypotheses {
    pub(super) fn new(candidates: Vec<Candidate>) -> Self {
        Self {
            candidates,
            base: None,
            ranking: EffectRanking::default(),
            combinations: Vec::new(),
            of_families: BTreeSet::new(),
            exchanged: BTreeSet::new(),
            gains: Vec::new(),
            laws: None,
            further_laws: None,
            predictive: Vec::new(),
        }
    }

    /// The base's fit.
    pub(super) fn base_fit(&self) -> Option<&LaplaceFit> {
        self.base.as_ref().map(|base| &base.fit)
    }

    /// Log evidence of the base; 0 before it is fitted.
    pub(super) fn base_evidence(&self) -> f64 {
        self.base.as_ref().map_or(0.0, |base| base.log_evidence)
    }

    /// Adds a combination unless the same one has more evidence already.
    pub(super) fn add(&mut self, combination: EffectCombination) {
        let effects = candidate_set(&combination.effects);
        let mut others = self.combinations.iter_mut();
        match others.find(|other| candidate_set(&other.effects) == effects) {
            Some(other) if other.log_bayes_factor < combination.log_bayes_factor => *other = combination,
            Some(_) => {}
            None => self.combinations.push(combination),
        }
        self.combinations
            .sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
    }

    /// The best combination, each effect after the first at its cost.
    pub(super) fn best(&self) -> Option<&EffectCombination> {
        self.best_of(|_| true)
    }

    /// The same of the library's effects alone: a combination that a law joined is no rival of that law.
    ///
    /// # Arguments
    /// - `library`: number of the library's effects, which come first among the candidates.
    pub(super) fn best_of_library(&self, library: usize) -> Option<&EffectCombination> {
        self.best_of(|combination| combination.effects.iter().all(|k| *k < library))
    }

    /// The best combination of the library's effects alone, if it is a detection.
    pub(super) fn detected_of_library(&self, library: usize) -> Option<&EffectCombination> {
        self.best_of_library(library)
            .filter(|best| best.log_bayes_factor > DETECTED)
    }

    fn best_of(&self, is_meant: impl Fn(&EffectCombination) -> bool) -> Option<&EffectCombination> {
        let score =
            |c: &EffectCombination| c.log_bayes_factor - COST_OF_CHOICE * (c.effects.len() as f64 - 1.0);
        self.combinations
            .iter()
            .filter(|combination| is_meant(combination))
            .reduce(|best, c| if score(c) > score(best) { c } else { best })
    }

    /// The best combination, if it is a detection.
    pub(super) fn detected(&self) -> Option<&EffectCombination> {
        self.best().filter(|best| best.log_bayes_factor > DETECTED)
    }

    /// A single effect.
    pub(super) fn single(&self, candidate: usize) -> Option<&EffectCombination> {
        self.of(&[candidate])
    }

    /// The combination of these effects, in this order.
    pub(super) fn of(&self, effects: &[usize]) -> Option<&EffectCombination> {
        self.combinations.iter().find(|c| c.effects == effects)
    }

    /// The log Bayes factor of these effects, if they were fitted together.
    pub(super) fn log_bayes_factor_of(&self, effects: &CandidateSet) -> Option<f64> {
        let mut combinations = self.combinations.iter();
        let own = combinations.find(|own| candidate_set(&own.effects) == *effects)?;
        Some(own.log_bayes_factor)
    }

    /// The scan for laws that is in progress or was the last.
    pub(super) fn current_scan(&mut self) -> Option<&mut LawScan> {
        self.further_laws.as_mut().or(self.laws.as_mut())
    }

    /// The law beyond the base that passed the cross-validation.
    pub(super) fn confirmed_law(&self) -> Option<&FittedLaw> {
        let scan = self.laws.as_ref()?;
        scan.laws.get(scan.confirmed?)
    }

    /// Goodness of fit of the detected combination, otherwise of the base.
    pub(super) fn chi_square(&self, likelihood: &Likelihood) -> Option<FitChiSquare> {
        let best = self.detected().map(|best| &best.fit);
        FitChiSquare::of(best.or(self.base_fit())?, likelihood)
    }

    /// Chi-square of the best explanation over its degrees of freedom: of the library's, or of a law that passed the
    /// cross-validation and fits better. 1 where it fits or the noise is not known.
    pub(super) fn misfit(&self, likelihood: &Likelihood) -> f64 {
        let library = self.chi_square(likelihood);
        let law = self
            .confirmed_law()
            .and_then(|law| FitChiSquare::of(&law.fit, likelihood));
        let best = [library, law]
            .into_iter()
            .flatten()
            .reduce(|a, b| if b.excess() < a.excess() { b } else { a });
        best.filter(|chi| !chi.is_complete())
            .map_or(1.0, |chi| chi.ratio())
    }

    /// Whether the best explanation contradicts the data, or with a model discrepancy the declared noise.
    pub(super) fn is_incomplete(&self, likelihood: &Likelihood) -> bool {
        let fit = self.detected().map(|best| &best.fit).or(self.base_fit());
        let chi = fit.and_then(|fit| FitChiSquare::of_known_noise(fit, likelihood));
        chi.is_some_and(|chi| !chi.is_complete())
    }
}
