//! The law outside the library that the verdict may claim: alone, or beside effects.

use crate::chi_square::FitChiSquare;
use crate::laplace::fit::LaplaceFit;
use crate::probability::DETECTED;
use crate::stages::hypotheses::{EffectCombination, FittedLaw, Hypotheses, candidate_set};
use crate::stages::law_curve::LawCurve;
use crate::stages::law_forms::FittedForm;
use crate::task::SearchTask;

/// A law outside the library explains the misfit if it leaves at most this share of the library's chi-square excess.
const MAX_LEFT: f64 = 0.25;

/// A law of a measured channel is claimed only if the best explanation without such a law falls short by more \[nats\].
const BEYOND_PHYSICS: f64 = 10.0;

/// A law that predicts left-out levels well enough to be claimed.
#[derive(Debug, Clone)]
pub(super) struct ClaimableLaw {
    /// Index of the law in the task.
    pub(super) law: usize,
    /// Index of its form or curve among the candidates.
    pub(super) candidate: usize,
    /// The law and the effects beside it, in the order of their parameters.
    pub(super) effects: Vec<usize>,
    /// Log evidence over that of the base.
    pub(super) log_bayes_factor: f64,
    pub(super) fit: LaplaceFit,
    /// What the data say of its curve; `None` where the curve was not fitted beyond these effects.
    pub(super) curve: Option<LawCurve>,
    /// Every fitted form of the law: the claimed one, then the others by falling Bayes factor.
    pub(super) forms: Vec<FittedForm>,
    /// Log predictive density of left-out levels over that of the base, and over that of the library's best.
    pub(super) left_out: [f64; 2],
}

impl ClaimableLaw {
    /// The law of the most probable set if it has one beside effects, otherwise the law alone; `None` if it does not predict left-out
    /// levels, leaves much of the misfit, or describes what a change of the physics may explain.
    ///
    /// # Arguments
    /// - `best`: the effects of the most probable set, if a law is among them.
    pub(super) fn new(task: &SearchTask, hypotheses: &Hypotheses, best: Option<&[usize]>) -> Option<Self> {
        let beside = best.and_then(|effects| Self::beside_effects(task, hypotheses, effects));
        // The probability of a set supports no other law than its own.
        let is_in_best = |law: &Self| {
            let is_same = |k: &usize| task.law_of(*k) == Some(law.law);
            best.is_none_or(|effects| effects.iter().any(is_same))
        };
        let law = beside.or_else(|| Self::alone(task, hypotheses).filter(is_in_best));
        law.filter(|law| law.is_beyond_physics(task, hypotheses))
    }

    /// Returns whether the law changes a stress, or no explanation comes near it that changes the physics alone: effects, a law of a
    /// stress, or both. The best fit of such an explanation may lie a little above the one that was found.
    fn is_beyond_physics(&self, task: &SearchTask, hypotheses: &Hypotheses) -> bool {
        if task.is_physical(&self.effects) {
            return true;
        }
        let possible = task.laws.len();
        let laws = || hypotheses.laws.iter().flat_map(|scan| &scan.laws);
        let score_alone = |law: &FittedLaw| law.log_bayes_factor - law.choice(possible);
        let alone = laws()
            .find(|law| self.effects == [law.candidate])
            .map(score_alone);
        let beside = hypotheses
            .combination(&self.effects)
            .map(EffectCombination::score);
        let Some(score) = beside.or(alone) else {
            return false;
        };
        let sets = hypotheses.combinations.iter();
        let sets = sets
            .filter(|set| task.is_physical(&set.effects))
            .map(EffectCombination::score);
        let of_stress = laws()
            .filter(|law| task.is_physical(&[law.candidate]))
            .map(score_alone);
        let misfit = hypotheses.misfit(&task.likelihood);
        sets.chain(of_stress)
            .all(|rival| (score - rival) / misfit > BEYOND_PHYSICS)
    }

    fn alone(task: &SearchTask, hypotheses: &Hypotheses) -> Option<Self> {
        let library = hypotheses.detected_of_library(task.library.len());
        let library = library.map(|best| &best.fit).or(hypotheses.base_fit());
        let chi_square = |fit: &LaplaceFit| FitChiSquare::of_fit(fit, &task.likelihood);
        let law = hypotheses.confirmed_law()?;
        let explains = match (library.and_then(chi_square), chi_square(&law.fit)) {
            (Some(library), Some(law)) => !law.is_wrong() || law.excess() < MAX_LEFT * library.excess(),
            _ => true,
        };
        explains.then(|| Self {
            law: law.law,
            candidate: law.candidate,
            effects: vec![law.candidate],
            log_bayes_factor: law.log_bayes_factor,
            fit: law.fit.clone(),
            curve: law.curve.clone(),
            forms: claimed_first(law.candidate, law.forms.clone()),
            left_out: law.left_out.unwrap_or([0.0; 2]),
        })
    }

    fn beside_effects(task: &SearchTask, hypotheses: &Hypotheses, effects: &[usize]) -> Option<Self> {
        let validated = hypotheses.law_beside_effects.as_ref()?;
        let set = hypotheses.combination(effects)?;
        let place = effects.iter().position(|k| task.is_law(*k))?;
        let candidate = effects[place];
        let law = task.law_of(candidate)?;
        let passes = validated.left_out.iter().all(|gain| *gain > DETECTED);
        if validated.effects != effects || !passes {
            return None;
        }
        let parameters = |k: &usize| hypotheses.candidates[*k].parameters.len();
        let before: usize = effects[..place].iter().map(parameters).sum();
        let first = task.prior.dimension() + before;
        let claimed = FittedForm::new(
            candidate,
            set.log_bayes_factor,
            &set.fit,
            first..first + parameters(&candidate),
        );
        let mut beyond = candidate_set(effects);
        beyond.remove(&candidate);
        let scanned = hypotheses.law_beyond(&beyond, law);
        Some(Self {
            law,
            candidate,
            effects: effects.to_vec(),
            log_bayes_factor: set.log_bayes_factor,
            fit: set.fit.clone(),
            curve: scanned.and_then(|(_, scanned)| scanned.curve.clone()),
            forms: forms_beside(hypotheses, set, law, claimed),
            left_out: validated.left_out,
        })
    }
}

/// Moves the claimed form, which the curve may exceed by a little, to the first place.
fn claimed_first(candidate: usize, mut forms: Vec<FittedForm>) -> Vec<FittedForm> {
    // The sort is stable.
    forms.sort_by_key(|form| form.candidate != candidate);
    forms
}

/// Returns the forms of the law of a set as they were fitted beyond its effects: the one of the set first, the others with log Bayes
/// factors on the scale of the set's.
fn forms_beside(
    hypotheses: &Hypotheses,
    set: &EffectCombination,
    law: usize,
    claimed: FittedForm,
) -> Vec<FittedForm> {
    let mut effects = candidate_set(&set.effects);
    effects.remove(&claimed.candidate);
    let mut forms = vec![claimed];
    if let Some((scan, scanned)) = hypotheses.law_beyond(&effects, law)
        && let Some(beyond) = hypotheses.combination(&scan.beyond)
    {
        let by = beyond.log_bayes_factor - set.choice;
        let others = scanned
            .forms
            .iter()
            .filter(|form| form.candidate != forms[0].candidate);
        let others: Vec<FittedForm> = others.map(|form| form.over(by)).collect();
        forms.extend(others);
    }
    forms
}
