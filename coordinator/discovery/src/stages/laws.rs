//! Steps 9 to 11, laws outside the library: curves, then simple forms, then the cross-validation of the best, first beyond the base
//! and then beyond the best combination if that leaves misfit.

use std::ops::Range;

use crate::chi_square::{FURTHER_EFFECT, FitChiSquare, OUTSIDE_LAW};
use crate::effect_search::depth::Depth;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::LaplaceFit;
use crate::probability::DETECTED;
use crate::stages::branch::SearchBranch;
use crate::stages::cross_validation::{ComparedModel, CrossValidation};
use crate::stages::hypotheses::{EffectCombination, FittedLaw, LawScan};
use crate::stages::law_curve::LawCurve;
use crate::stages::law_forms::FittedForm;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

/// Number of laws, the best, whose simple forms are fitted and that are cross-validated.
pub(super) const LAWS: usize = 3;
/// A strength farther out in its prior may stand for a law \[standard deviations\].
const FAR_OUT: f64 = 3.0;
/// Number of single effects, the best, beyond which laws are scanned.
const SINGLES: usize = 3;
/// A curve is kept if its log Bayes factor exceeds that of the best simple form by more \[nats\].
const CURVE_BEATS_FORM: f64 = 5.0;

impl SearchState {
    /// Searches curves outside the library if the library leaves misfit, or if it needs several effects, which one law may replace.
    pub(super) fn curves(&mut self) -> Stage {
        let chi_square = self.hypotheses.chi_square(&self.task.likelihood);
        let is_far_out =
            |best: &EffectCombination| best.fit.frame.largest_strength(&best.fit.point.position) > FAR_OUT;
        let leaves_misfit = match (chi_square, self.hypotheses.detected()) {
            (_, Some(best)) if is_far_out(best) => true,
            (Some(chi), None) => chi.p() < OUTSIDE_LAW,
            (Some(chi), Some(best)) => best.effects.len() > 1 || chi.p() < FURTHER_EFFECT,
            (None, detected) => detected.is_some(),
        };
        if !leaves_misfit {
            return self.further_curves();
        }
        self.scan(Vec::new(), chi_square)
    }

    /// Searches curves beyond the best combination, if it contradicts the data and no law beyond the base explains them, and beyond the
    /// leading effects where a law may act beside one of them.
    fn further_curves(&mut self) -> Stage {
        if self.hypotheses.unscanned.is_none() {
            self.hypotheses.unscanned = Some(self.sets_beside_laws());
        }
        match self.hypotheses.unscanned.as_mut().and_then(Vec::pop) {
            Some(effects) => {
                let combination = self.hypotheses.combination(&effects);
                let chi =
                    combination.and_then(|c| FitChiSquare::of_declared_noise(&c.fit, &self.task.likelihood));
                self.scan(effects, chi)
            }
            None => self.effects_beside_law(1),
        }
    }

    /// Returns the sets of effects beyond which laws are scanned, the last first.
    fn sets_beside_laws(&self) -> Vec<Vec<usize>> {
        let hypotheses = &self.hypotheses;
        let chi_square = |fit: &LaplaceFit| FitChiSquare::of_declared_noise(fit, &self.task.likelihood);
        let law = hypotheses.confirmed_law().and_then(|law| chi_square(&law.fit));
        let is_explained = law.is_some_and(|chi| chi.is_complete());
        let is_switch = |k: &usize| hypotheses.candidates[*k].is_switch();
        let combines = |c: &&EffectCombination| !c.effects.iter().any(is_switch);
        let best = hypotheses.detected().filter(|_| !is_explained);
        let best = best.filter(|best| chi_square(&best.fit).is_some_and(|chi| !chi.is_complete()));
        let mut sets = Vec::new();
        if self.seeks_laws_beside_effects() {
            let singles = hypotheses.combinations.iter().filter(|c| c.effects.len() == 1);
            let singles = singles.filter(|c| c.log_bayes_factor > DETECTED).filter(combines);
            sets.extend(singles.take(SINGLES).map(|c| c.effects.clone()));
        }
        if let Some(best) = best.filter(combines)
            && !sets.contains(&best.effects)
        {
            sets.push(best.effects.clone());
        }
        sets
    }

    /// Fits the curves of all laws beyond a model.
    ///
    /// # Arguments
    /// - `beyond`: the effects of the model; none: the base. `chi_square`: goodness of fit of the best explanation so far.
    fn scan(&mut self, beyond: Vec<usize>, chi_square: Option<FitChiSquare>) -> Stage {
        let is_wrong = chi_square.is_some_and(|chi| chi.is_wrong());
        let depth = Depth::of_curves(self.task.settings.smoothness, is_wrong);
        let curves: Vec<usize> = (0..self.task.laws.len())
            .map(|law| self.task.curve(law))
            .collect();
        match self.branch(beyond, curves, depth) {
            Some(branch) => Stage::Curves(branch),
            None => self.further_curves(),
        }
    }

    /// Keeps the curves, and fits the simple forms of the best.
    pub(super) fn after_curves(&mut self, branch: &SearchBranch) -> Stage {
        let scan = self.scan_of(branch);
        let best = scan.laws.iter().take(LAWS);
        let forms = best.flat_map(|law| self.task.forms(law.law)).collect();
        let forms = self.branch(
            scan.beyond.clone(),
            forms,
            Depth::of_forms(self.task.settings.smoothness),
        );
        if scan.beyond.is_empty() {
            self.hypotheses.laws = Some(scan);
        } else {
            self.hypotheses.further_laws.push(scan);
        }
        match forms {
            Some(branch) => Stage::Forms(branch),
            None => self.after_scan(),
        }
    }

    /// Returns the laws whose curves a branch has fitted.
    pub(super) fn scan_of(&self, branch: &SearchBranch) -> LawScan {
        let laws = branch.ranked().into_iter().filter_map(|(candidate, ranked)| {
            let law = self.task.law_of(candidate)?;
            let fit = branch.search.fit_of(ranked.candidate?)?;
            let factor = ranked.log_bayes_factor;
            (candidate == self.task.curve(law)).then(|| FittedLaw {
                law,
                candidate,
                log_bayes_factor: factor,
                mean_log_bayes_factor: factor,
                handicap: self.task.handicap(law),
                fit: fit.clone(),
                curve: LawCurve::new(fit, &self.task.likelihood, branch.added_parameters(fit)),
                forms: vec![FittedForm::new(
                    candidate,
                    factor,
                    fit,
                    branch.added_parameters(fit),
                )],
                left_out: None,
            })
        });
        LawScan {
            beyond: branch.effects.clone(),
            laws: laws.collect(),
            confirmed: None,
        }
    }

    /// Describes each law by its best form or its curve, and begins the cross-validation.
    pub(super) fn after_forms(&mut self, branch: &SearchBranch) -> Stage {
        let task = &self.task;
        let Some(scan) = self.hypotheses.current_scan() else {
            return self.replacements();
        };
        for law in &mut scan.laws {
            law.describe(task.forms(law.law), branch);
        }
        let score = |law: &FittedLaw| law.log_bayes_factor - law.handicap;
        scan.laws.sort_by(|a, b| score(b).total_cmp(&score(a)));
        if scan.beyond.is_empty() {
            self.cross_validation(0)
        } else {
            self.after_scan()
        }
    }

    /// Cross-validates the law of this rank if it is a detection.
    fn cross_validation(&mut self, rank: usize) -> Stage {
        let scan = self.hypotheses.laws.as_ref();
        let law = scan.and_then(|scan| Some((scan.beyond.clone(), scan.laws.get(rank)?.clone())));
        let law = law.filter(|(_, law)| rank < LAWS && law.log_bayes_factor > DETECTED);
        let (Some((beyond, law)), Some(base)) = (law, self.hypotheses.base_fit()) else {
            return self.after_scan();
        };
        let base: ComparedModel = (Vec::new(), 0, base);
        let library = self.hypotheses.best_of_library(self.task.library.len());
        let library = library.map_or_else(|| base.clone(), |best| self.compared(best));
        let mut effects = beyond;
        effects.push(law.candidate);
        let with_law = (effects, self.last_parameters(&[law.candidate]), &law.fit);
        let fits = [base, library, with_law];
        Stage::CrossValidation(rank, self.validated(&fits))
    }

    /// Confirms the law of this rank if it predicts left-out levels, or cross-validates the next.
    pub(super) fn after_cross_validation(&mut self, rank: usize, validation: &CrossValidation) -> Stage {
        self.keep_refits(validation);
        // Gains over the base, and over the library's best.
        let gains = validation.gains().and_then(|gains| match gains.as_slice() {
            &[base, library, law] => Some([law - base, law - library]),
            _ => None,
        });
        let Some(scan) = self.hypotheses.current_scan() else {
            return self.replacements();
        };
        // A law that replaces the library's best must not predict worse.
        let passes =
            gains.is_some_and(|[over_base, over_library]| over_base > DETECTED && over_library > 0.0);
        if let Some(law) = scan.laws.get_mut(rank) {
            law.left_out = gains;
        }
        if !passes {
            return self.cross_validation(rank + 1);
        }
        scan.confirmed = Some(rank);
        self.after_scan()
    }

    /// Ends a scan.
    fn after_scan(&mut self) -> Stage {
        self.add_scanned();
        self.further_curves()
    }

    /// Lets the laws that gain a detectable amount beyond the set that was scanned last join it.
    pub(super) fn add_scanned(&mut self) {
        if let Some(scan) = self.hypotheses.further_laws.last() {
            let scanned = self.hypotheses.combination(&scan.beyond);
            let possible = self.task.laws.len();
            let with = |law: &FittedLaw| {
                let mut effects = scan.beyond.clone();
                effects.push(law.candidate);
                let scanned = scanned?.log_bayes_factor;
                let choice = law.choice(possible);
                Some(EffectCombination {
                    effects,
                    log_bayes_factor: scanned + law.log_bayes_factor - choice,
                    choice,
                    fit: law.fit.clone(),
                })
            };
            let laws = scan
                .laws
                .iter()
                .take(LAWS)
                .filter(|law| law.log_bayes_factor > DETECTED);
            let sets: Vec<EffectCombination> = laws.filter_map(with).collect();
            sets.into_iter().for_each(|set| self.hypotheses.add(set));
        }
    }
}

impl FittedLaw {
    /// Keeps the forms that a branch has fitted, and describes the law by the best of them or by its curve.
    ///
    /// # Arguments
    /// - `indices`: of the law's forms among the candidates.
    pub(super) fn describe(&mut self, indices: Range<usize>, branch: &SearchBranch) {
        let forms = branch.ranked().into_iter();
        let forms: Vec<_> = forms.filter(|(k, _)| indices.contains(k)).collect();
        let fitted = forms.iter().filter_map(|(k, form)| {
            let fit = branch.search.fit_of(form.candidate?)?;
            Some((*k, form.log_bayes_factor, fit))
        });
        let fitted: Vec<_> = fitted.collect();
        // A form that was screened alone counts as without evidence: the screen may promise far more than a fit keeps.
        let factors = fitted.iter().map(|(_, factor, _)| *factor);
        let all = factors.chain([self.log_bayes_factor]);
        self.mean_log_bayes_factor = log_sum_exp(all) - libm::log(1.0 + indices.len() as f64);
        self.forms.extend(fitted.iter().map(|(candidate, factor, fit)| {
            FittedForm::new(*candidate, *factor, fit, branch.added_parameters(fit))
        }));
        self.forms
            .sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
        if let Some((candidate, factor, fit)) = fitted.first()
            && *factor > self.log_bayes_factor - CURVE_BEATS_FORM
        {
            (self.candidate, self.log_bayes_factor, self.fit) = (*candidate, *factor, (*fit).clone());
        }
    }
}
