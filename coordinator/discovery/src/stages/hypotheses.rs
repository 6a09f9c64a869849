//! The hypotheses of a discovery: the combinations of effects and the laws outside the library that its stages have fitted.

use std::collections::BTreeSet;

use crate::candidate::Candidate;
use crate::chi_square::FitChiSquare;
use crate::effect_search::ranking::EffectRanking;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::probability::{DETECTED, counted_evidence};
use crate::stages::formula_fit::FormulaFit;
use crate::stages::law_curve::LawCurve;
use crate::stages::law_forms::FittedForm;
use crate::stages::scored_fit::ScoredFit;
use statistics::likelihood::Likelihood;

/// Cost of each effect after the first \[nats\]: a bound of the gain by selection from the library.
const COST_OF_CHOICE: f64 = 5.0;

/// The results of the stages so far.
#[derive(Debug, Clone)]
pub(super) struct Hypotheses {
    pub(super) candidates: Vec<Candidate>,
    pub(super) base: Option<FittedModel>,
    /// Result of the search for one effect.
    pub(super) ranking: EffectRanking,
    /// Combinations by falling Bayes factor, including single effects.
    pub(super) combinations: Vec<EffectCombination>,
    /// The sets of effects of one family that were fitted together.
    pub(super) family_sets: BTreeSet<CandidateSet>,
    /// The sets that were fitted after an exchange of one effect.
    pub(super) exchanged: BTreeSet<CandidateSet>,
    /// The base without each effect that may be dropped; `None` where the reduction cannot be fitted.
    pub(super) reduced: Vec<Option<FittedModel>>,
    /// The base with a leading candidate in the place of one of its effects.
    pub(super) replacements: Vec<FittedReplacement>,
    /// Laws outside the library beyond the base; `None`: not searched.
    pub(super) laws: Option<LawScan>,
    /// Laws outside the library beyond sets of effects, in the order in which they were scanned.
    pub(super) further_laws: Vec<LawScan>,
    /// The sets beyond which laws are still to be scanned; `None` before they are chosen.
    pub(super) unscanned: Option<Vec<Vec<usize>>>,
    /// The cross-validation of the best set that has a law beside effects; `None`: there is no such set.
    pub(super) law_beside_effects: Option<LawBesideEffects>,
    /// Formulas of the law that is claimed, by falling Bayes factor.
    pub(super) formulas: Vec<FormulaFit>,
    /// The leading sets with their log predictive density of left-out levels over that of the base.
    pub(super) predictive: Vec<(Vec<usize>, f64)>,
}

/// Candidates that act together, in any order.
pub(super) type CandidateSet = BTreeSet<usize>;

/// Returns the set of some effects.
pub(super) fn candidate_set(effects: &[usize]) -> CandidateSet {
    effects.iter().copied().collect()
}

/// Effects that act together, with their fit.
#[derive(Debug, Clone)]
pub(super) struct EffectCombination {
    /// The effects in the order in which their parameters follow the base's.
    pub(super) effects: Vec<usize>,
    /// Log evidence over that of the base, less `choice`.
    pub(super) log_bayes_factor: f64,
    /// Cost of the choice of a law among all laws and of its form \[nats\]; 0 without a law.
    pub(super) choice: f64,
    pub(super) fit: LaplaceFit,
}

impl EffectCombination {
    /// Log evidence over that of the base, less the cost of each effect after the first.
    pub(super) fn score(&self) -> f64 {
        self.log_bayes_factor - COST_OF_CHOICE * (self.effects.len() as f64 - 1.0)
    }

    /// Log prior cost of its members \[nats\]: each effect of the library is one of all, and the law has its [`Self::choice`].
    ///
    /// # Arguments
    /// - `library`: number of the library's effects, which come first among the candidates.
    pub(super) fn prior_cost(&self, library: usize) -> f64 {
        let of_library = self.effects.iter().filter(|k| **k < library).count();
        of_library as f64 * libm::log(library.max(1) as f64) + self.choice
    }

    /// Log evidence over that of the base, of this law in this form.
    pub(super) fn fitted_log_bayes_factor(&self) -> f64 {
        self.log_bayes_factor + self.choice
    }
}

/// The fit of the base with a candidate in the place of one of its effects.
#[derive(Debug, Clone)]
pub(super) struct FittedReplacement {
    /// Index of the reduction that is without the effect.
    pub(super) reduction: usize,
    pub(super) candidate: usize,
    /// Log evidence over that of the base.
    pub(super) log_bayes_factor: f64,
    pub(super) fit: LaplaceFit,
    /// The likelihood of the reduction.
    pub(super) likelihood: Likelihood,
}

impl FittedReplacement {
    pub(super) fn scored(&self) -> ScoredFit<'_> {
        ScoredFit {
            fit: &self.fit,
            likelihood: &self.likelihood,
        }
    }
}

/// The cross-validation of a law that acts together with effects.
#[derive(Debug, Clone)]
pub(super) struct LawBesideEffects {
    /// The effects and the law.
    pub(super) effects: Vec<usize>,
    /// Log predictive density of the left-out data over that of the base, and over that of the library's best combination.
    pub(super) left_out: [f64; 2],
}

/// Laws outside the library, fitted beyond one model.
#[derive(Debug, Clone)]
pub(super) struct LawScan {
    pub(super) beyond: Vec<usize>,
    /// The laws by falling Bayes factor, one for each quantity and variable.
    pub(super) laws: Vec<FittedLaw>,
    pub(super) confirmed: Option<usize>,
}

/// A fitted law outside the library.
#[derive(Debug, Clone)]
pub(super) struct FittedLaw {
    /// Index of the law in the task.
    pub(super) law: usize,
    /// Index of the candidate that describes it best: a form, or the curve.
    pub(super) candidate: usize,
    /// Log evidence over that of the model that was scanned.
    pub(super) log_bayes_factor: f64,
    /// Log Bayes factor of the mean evidence of curve and forms.
    pub(super) mean_log_bayes_factor: f64,
    /// Log prior odds of a law that changes a stress over this one: [`DETECTED`] for a law that changes a channel \[nats\].
    pub(super) handicap: f64,
    pub(super) fit: LaplaceFit,
    /// What the data say of its curve.
    pub(super) curve: Option<LawCurve>,
    /// The curve and every form that was fitted, by falling Bayes factor.
    pub(super) forms: Vec<FittedForm>,
    /// Log predictive density of the left-out data over that of the base, and over that of the library's best combination.
    pub(super) left_out: Option<[f64; 2]>,
}

impl FittedLaw {
    /// Cost of the choice of this law among all laws and of its form, with the handicap \[nats\].
    ///
    /// # Arguments
    /// - `possible`: number of all laws.
    pub(super) fn choice(&self, possible: usize) -> f64 {
        self.log_bayes_factor - self.mean_log_bayes_factor + libm::log(possible.max(1) as f64) + self.handicap
    }
}

impl LawScan {
    /// Returns the log Bayes factor of a law outside the library over the model that was scanned: the mean over all possible
    /// laws, each less its handicap, where one that could not be fitted counts as without evidence.
    pub(super) fn log_bayes_factor(&self, possible: usize) -> f64 {
        let means = self
            .laws
            .iter()
            .map(|law| law.mean_log_bayes_factor - law.handicap);
        log_sum_exp(means) - libm::log(possible.max(1) as f64)
    }

    /// Returns each law with its log weight: the counted evidence of its best form, less its costs.
    ///
    /// # Arguments
    /// - `possible`: number of all laws. `misfit`: chi-square of the best explanation over its degrees of freedom.
    pub(super) fn log_weights(
        &self,
        possible: usize,
        misfit: f64,
    ) -> impl Iterator<Item = (usize, f64)> + Clone {
        self.laws.iter().map(move |law| {
            let evidence = counted_evidence(law.log_bayes_factor, misfit);
            (law.law, evidence - law.choice(possible))
        })
    }

    /// Returns each law with its share of the mean evidence of all.
    ///
    /// # Arguments
    /// - `possible`, `misfit`: as of [`Self::log_weights`].
    pub(super) fn shares(&self, possible: usize, misfit: f64) -> impl Iterator<Item = (&FittedLaw, f64)> {
        let weights = self.log_weights(possible, misfit);
        let of_all = log_sum_exp(weights.clone().map(|(_, weight)| weight));
        let shares = weights.map(move |(_, weight)| libm::exp(weight - of_all));
        self.laws.iter().zip(shares)
    }
}

impl Hypotheses {
    pub(super) fn new(candidates: Vec<Candidate>) -> Self {
        Self {
            candidates,
            base: None,
            ranking: EffectRanking::default(),
            combinations: Vec::new(),
            family_sets: BTreeSet::new(),
            exchanged: BTreeSet::new(),
            reduced: Vec::new(),
            replacements: Vec::new(),
            laws: None,
            further_laws: Vec::new(),
            unscanned: None,
            law_beside_effects: None,
            formulas: Vec::new(),
            predictive: Vec::new(),
        }
    }

    pub(super) fn base_fit(&self) -> Option<&LaplaceFit> {
        self.base.as_ref().map(|base| &base.fit)
    }

    /// Returns the log evidence of the base; 0 before it is fitted.
    pub(super) fn base_evidence(&self) -> f64 {
        self.base.as_ref().map_or(0.0, |base| base.log_evidence)
    }

    /// Returns the log Bayes factor of the base over itself without each effect that may be dropped; `None` where the reduction cannot be
    /// fitted.
    pub(super) fn gains(&self) -> Vec<Option<f64>> {
        let base = self.base_evidence();
        let reduced = self.reduced.iter();
        let gain = |reduced: &FittedModel| base - reduced.log_evidence;
        reduced.map(|reduced| reduced.as_ref().map(gain)).collect()
    }

    /// Adds a combination, unless the same set has more evidence already.
    pub(super) fn add(&mut self, combination: EffectCombination) {
        let effects = candidate_set(&combination.effects);
        let mut combinations = self.combinations.iter_mut();
        match combinations.find(|existing| candidate_set(&existing.effects) == effects) {
            Some(existing) if existing.log_bayes_factor < combination.log_bayes_factor => {
                *existing = combination
            }
            Some(_) => {}
            None => self.combinations.push(combination),
        }
        self.combinations
            .sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
    }

    /// Returns the fit of a candidate in the place of the effect that a reduction is without.
    pub(super) fn replacement(&self, reduction: usize, candidate: usize) -> Option<&FittedReplacement> {
        let mut replacements = self.replacements.iter();
        replacements.find(|fitted| fitted.reduction == reduction && fitted.candidate == candidate)
    }

    /// Returns the best combination, after the cost of each effect after the first.
    pub(super) fn best(&self) -> Option<&EffectCombination> {
        self.best_of(|_| true)
    }

    /// Returns the best combination of library effects alone: a combination that includes a law is no rival of that law.
    ///
    /// # Arguments
    /// - `library`: number of the library's effects, which come first among the candidates.
    pub(super) fn best_of_library(&self, library: usize) -> Option<&EffectCombination> {
        self.best_of(|combination| combination.effects.iter().all(|k| *k < library))
    }

    /// Returns the best combination of the library's effects alone, if it is a detection.
    pub(super) fn detected_of_library(&self, library: usize) -> Option<&EffectCombination> {
        self.best_of_library(library)
            .filter(|best| best.log_bayes_factor > DETECTED)
    }

    pub(super) fn best_of(
        &self,
        is_eligible: impl Fn(&EffectCombination) -> bool,
    ) -> Option<&EffectCombination> {
        self.combinations
            .iter()
            .filter(|combination| is_eligible(combination))
            .reduce(|best, c| if c.score() > best.score() { c } else { best })
    }

    /// Returns the best combination, if it is a detection.
    pub(super) fn detected(&self) -> Option<&EffectCombination> {
        self.best().filter(|best| best.log_bayes_factor > DETECTED)
    }

    /// Returns the combination of one effect.
    pub(super) fn single(&self, candidate: usize) -> Option<&EffectCombination> {
        self.combination(&[candidate])
    }

    /// Returns the combination of these effects in this order.
    pub(super) fn combination(&self, effects: &[usize]) -> Option<&EffectCombination> {
        self.combinations.iter().find(|c| c.effects == effects)
    }

    /// Returns the combination of these effects in any order.
    pub(super) fn of_set(&self, effects: &CandidateSet) -> Option<&EffectCombination> {
        let mut combinations = self.combinations.iter();
        combinations.find(|c| candidate_set(&c.effects) == *effects)
    }

    /// Returns the log Bayes factor of these effects, if they were fitted together.
    pub(super) fn log_bayes_factor_of(&self, effects: &CandidateSet) -> Option<f64> {
        Some(self.of_set(effects)?.log_bayes_factor)
    }

    /// Returns a law as it was scanned beyond these effects, if its forms were fitted there.
    ///
    /// # Arguments
    /// - `law`: index of the law in the task.
    pub(super) fn law_beyond(&self, effects: &CandidateSet, law: usize) -> Option<(&LawScan, &FittedLaw)> {
        let mut scans = self.further_laws.iter().rev();
        scans.find_map(|scan| {
            let is_beyond = candidate_set(&scan.beyond) == *effects;
            let has_forms = |found: &&FittedLaw| found.law == law && found.forms.len() > 1;
            let found = scan.laws.iter().filter(|_| is_beyond).find(has_forms)?;
            Some((scan, found))
        })
    }

    /// Returns the scan for laws that is in progress, or the last one.
    pub(super) fn current_scan(&mut self) -> Option<&mut LawScan> {
        self.further_laws.last_mut().or(self.laws.as_mut())
    }

    /// Returns the law beyond the base that passed the cross-validation.
    pub(super) fn confirmed_law(&self) -> Option<&FittedLaw> {
        let scan = self.laws.as_ref()?;
        scan.laws.get(scan.confirmed?)
    }

    /// Returns the goodness of fit of the detected combination, otherwise of the base.
    pub(super) fn chi_square(&self, likelihood: &Likelihood) -> Option<FitChiSquare> {
        let best = self.detected().map(|best| &best.fit);
        FitChiSquare::of_fit(best.or(self.base_fit())?, likelihood)
    }

    /// Returns the chi-square over degrees of freedom of the best explanation, which is the library's or a law that passed the
    /// cross-validation and fits better. 1 where it fits or the noise is not known.
    pub(super) fn misfit(&self, likelihood: &Likelihood) -> f64 {
        let library = self.chi_square(likelihood);
        let law = self
            .confirmed_law()
            .and_then(|law| FitChiSquare::of_fit(&law.fit, likelihood));
        let best = [library, law]
            .into_iter()
            .flatten()
            .reduce(|a, b| if b.excess() < a.excess() { b } else { a });
        best.filter(|chi| !chi.is_complete())
            .map_or(1.0, |chi| chi.ratio())
    }

    /// Returns whether the best explanation contradicts the data; with a model discrepancy, by the declared noise.
    pub(super) fn is_incomplete(&self, likelihood: &Likelihood) -> bool {
        let fit = self.detected().map(|best| &best.fit).or(self.base_fit());
        let chi = fit.and_then(|fit| FitChiSquare::of_declared_noise(fit, likelihood));
        chi.is_some_and(|chi| !chi.is_complete())
    }
}
