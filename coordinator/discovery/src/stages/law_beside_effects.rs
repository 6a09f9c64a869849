//! The stages in which a law outside the library and effects of the library act together: effects beyond the best laws, and the
//! cross-validation of the best set that has both.

use crate::chi_square::{FURTHER_EFFECT, FitChiSquare};
use crate::effect_search::depth::{Depth, GLANCE, QUICK};
use crate::probability::DETECTED;
use crate::settings::Smoothness;
use crate::stages::branch::SearchBranch;
use crate::stages::cross_validation::{ComparedModel, CrossValidation};
use crate::stages::hypotheses::{EffectCombination, LawBesideEffects, candidate_set};
use crate::stages::laws::LAWS;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

impl SearchState {
    /// Returns whether laws and effects are searched together: laws were scanned, and the model's evaluations are cheap.
    pub(super) fn seeks_laws_beside_effects(&self) -> bool {
        let is_smooth = self.task.settings.smoothness == Smoothness::Smooth;
        is_smooth && self.task.max_effects > 0 && self.hypotheses.laws.is_some()
    }

    /// Returns the best sets that have a law and this number of members, with the cost of the choice of that law.
    fn sets_with_law(&self, size: usize) -> Vec<(Vec<usize>, f64)> {
        let hypotheses = &self.hypotheses;
        if size == 1 {
            let laws = hypotheses.laws.iter().flat_map(|scan| &scan.laws);
            let laws = laws.filter(|law| law.log_bayes_factor > DETECTED).take(LAWS);
            let possible = self.task.laws.len();
            return laws
                .map(|law| (vec![law.candidate], law.choice(possible)))
                .collect();
        }
        let sets = hypotheses.combinations.iter().filter(|c| c.effects.len() == size);
        let sets = sets.filter(|c| self.has_law(&c.effects)).take(LAWS);
        sets.map(|c| (c.effects.clone(), c.choice)).collect()
    }

    /// Searches one more effect beyond the best sets of a size that have a law, beyond the best of all more deeply.
    pub(super) fn effects_beside_law(&mut self, size: usize) -> Stage {
        if !self.seeks_laws_beside_effects() || size > self.task.max_effects {
            return self.law_elimination();
        }
        let branch = |(rank, (effects, choice)): (usize, &(Vec<usize>, f64))| {
            let depth = if rank == 0 { &QUICK } else { &GLANCE };
            let branch = self.branch(effects.clone(), self.further_effects(effects), depth)?;
            Some(branch.with_choice(*choice))
        };
        let sets = self.sets_with_law(size);
        let branches: Vec<SearchBranch> = sets.iter().enumerate().filter_map(branch).collect();
        Stage::EffectsBesideLaw(size, branches)
    }

    pub(super) fn after_effects_beside_law(&mut self, size: usize, branches: &[SearchBranch]) -> Stage {
        for branch in branches {
            self.add_combinations(branch);
        }
        let best = self.best_with_law();
        let has_grown = best.is_some_and(|best| best.effects.len() > size);
        let leaves_misfit = best
            .and_then(|best| FitChiSquare::of_fit(&best.fit, &self.task.likelihood))
            .is_none_or(|chi| chi.p() < FURTHER_EFFECT);
        if has_grown && leaves_misfit {
            self.effects_beside_law(size + 1)
        } else {
            self.law_elimination()
        }
    }

    /// Returns the best set that has a law and effects.
    pub(super) fn best_with_law(&self) -> Option<&EffectCombination> {
        self.hypotheses
            .best_of(|c| c.effects.len() > 1 && self.has_law(&c.effects))
    }

    /// Fits the best set that has a law without each of its effects.
    fn law_elimination(&mut self) -> Stage {
        match self.best_with_law() {
            Some(best) if best.effects.len() > 2 => Stage::LawElimination(self.without_each(best)),
            _ => self.law_forms(),
        }
    }

    pub(super) fn after_law_elimination(&mut self, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        self.law_forms()
    }

    /// Fits curve and forms of the law of the best set that has one beyond the effects of that set, unless a scan has: beside other
    /// effects another form may be the best.
    fn law_forms(&mut self) -> Stage {
        let unfitted = self.best_with_law().and_then(|best| {
            let place = best.effects.iter().position(|k| self.task.is_law(*k))?;
            let law = self.task.law_of(best.effects[place])?;
            let mut effects = candidate_set(&best.effects);
            effects.remove(&best.effects[place]);
            let is_fitted = self.hypotheses.law_beyond(&effects, law).is_some();
            let beyond = self.hypotheses.of_set(&effects).filter(|_| !is_fitted)?;
            let mut candidates = vec![self.task.curve(law)];
            candidates.extend(self.task.forms(law));
            let depth = Depth::of_law(self.task.settings.smoothness);
            Some((law, self.branch(beyond.effects.clone(), candidates, depth)?))
        });
        match unfitted {
            Some((law, branch)) => Stage::LawForms(law, branch),
            None => self.law_substitutes(),
        }
    }

    pub(super) fn after_law_forms(&mut self, law: usize, branch: &SearchBranch) -> Stage {
        let mut scan = self.scan_of(branch);
        for found in &mut scan.laws {
            found.describe(self.task.forms(law), branch);
        }
        self.hypotheses.further_laws.push(scan);
        self.add_scanned();
        self.law_substitutes()
    }

    /// Cross-validates the best set that has a law against the library's best.
    pub(super) fn law_validation(&mut self) -> Stage {
        let (Some(best), Some(base)) = (self.best_with_law(), self.hypotheses.base_fit()) else {
            return self.replacements();
        };
        let base: ComparedModel = (Vec::new(), 0, base);
        let library = self.hypotheses.best_of_library(self.task.library.len());
        let library = library.map_or_else(|| base.clone(), |set| self.compared(set));
        let fits = [base, library, self.compared(best)];
        Stage::LawBesideEffects(best.effects.clone(), self.validated(&fits))
    }

    pub(super) fn after_law_beside_effects(
        &mut self,
        effects: &[usize],
        validation: &CrossValidation,
    ) -> Stage {
        self.keep_refits(validation);
        if let Some(&[base, library, law]) = validation.gains().as_deref() {
            self.hypotheses.law_beside_effects = Some(LawBesideEffects {
                effects: effects.to_vec(),
                left_out: [law - base, law - library],
            });
        }
        self.replacements()
    }
}
