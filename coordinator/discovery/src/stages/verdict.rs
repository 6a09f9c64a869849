//! The verdict of a discovery, from the probabilities (step 13).

use crate::probability::DETECTED;
use crate::stages::claimable_law::ClaimableLaw;
use crate::stages::hypotheses::Hypotheses;
use crate::stages::law_places::LawPlaces;
use crate::stages::weighing::Weighing;
use crate::task::SearchTask;

/// An effect, a class or a law is claimed if its probability is higher.
pub const NAMED: f64 = 0.9;

/// The conclusion that the data support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchVerdict {
    /// No explanation beats the base.
    NothingDetectable,
    /// This candidate is missing.
    Named(usize),
    /// One of the candidates of this class, which the data cannot distinguish, is missing.
    Class(usize),
    /// A law outside the library is missing.
    NotInLibrary,
    /// Something is missing, and the data do not decide between the explanations.
    Undecided,
}

impl SearchVerdict {
    /// Returns what the probabilities support, before objections, with the law that may be claimed.
    pub(super) fn supported(
        task: &SearchTask,
        hypotheses: &Hypotheses,
        weighing: &Weighing,
    ) -> (Self, Option<ClaimableLaw>) {
        let law = ClaimableLaw::new(task, hypotheses, weighing.best_with_law());
        let is_incomplete = hypotheses.is_incomplete(&task.likelihood);
        let verdict = Self::new(task, weighing, hypotheses, law.as_ref(), is_incomplete);
        (verdict, law)
    }

    /// Returns whether the verdict names a missing effect, class or law.
    pub fn is_claim(self) -> bool {
        matches!(self, Self::Named(_) | Self::Class(_) | Self::NotInLibrary)
    }

    /// Derives the verdict from the probabilities. They account for a misfit that remains with the best explanation, so a misfit
    /// prevents a name only where a law acts beside effects.
    ///
    /// # Arguments
    /// - `law`: the law that may be claimed. `is_incomplete`: whether the best explanation contradicts the data; with a model
    ///   discrepancy, the declared noise.
    fn new(
        task: &SearchTask,
        weighing: &Weighing,
        hypotheses: &Hypotheses,
        law: Option<&ClaimableLaw>,
        is_incomplete: bool,
    ) -> Self {
        let effects = &weighing.ranking.effects;
        let library = hypotheses.best_of_library(task.library.len());
        let library = library.map_or(0.0, |best| best.log_bayes_factor);
        let is_detected = |log_bayes_factor: f64| log_bayes_factor / weighing.misfit > DETECTED;
        let law = law.filter(|law| is_detected(law.log_bayes_factor - library.max(0.0)));
        let places = LawPlaces::new(task, hypotheses, weighing);
        let law = law.filter(|law| places.rival_probability(task, law.law) < 1.0 - NAMED);
        let of_law = weighing
            .not_in_library
            .map_or(0.0, |(_, probability)| probability);
        // Without a detection in the library, one of many laws may fit by chance; the probability accounts for their number.
        if law.is_some() && of_law > if is_detected(library) { 0.5 } else { NAMED } {
            return Self::NotInLibrary;
        }
        let nothing = if is_incomplete {
            Self::Undecided
        } else {
            Self::NothingDetectable
        };
        if !hypotheses
            .best()
            .is_some_and(|best| is_detected(best.log_bayes_factor))
        {
            return nothing;
        }
        // With a discrepancy the model is expected to contradict the noise.
        let is_contradicted = is_incomplete && !task.likelihood.has_discrepancy();
        // The law of the best set may be what acts, and the effects make up for its form.
        let may_be_named = |is_named: &dyn Fn(usize) -> bool| {
            weighing.stands_beside_law(is_named) && !(is_contradicted && weighing.best_with_law().is_some())
        };
        // A law that does not lead is claimed only if nothing contradicts the set in which it stands.
        let is_law = law.is_some() && !is_contradicted && weighing.law_probability() > NAMED;
        let open = if is_law {
            Self::NotInLibrary
        } else {
            Self::Undecided
        };
        let best = effects
            .iter()
            .reduce(|a, b| if b.probability > a.probability { b } else { a });
        let candidates = &hypotheses.candidates;
        // A parameter and its limit are one claim, which the more probable of them states.
        let claim_probability = |k: usize| -> f64 {
            let is_same = |other: usize| candidates[other].is_same_parameter(&candidates[k]);
            let same = effects.iter().filter(|e| e.candidate.is_some_and(is_same));
            same.map(|e| e.probability).sum()
        };
        let is_probable = |candidate: Option<usize>| candidate.is_none_or(|k| claim_probability(k) > NAMED);
        match best {
            // Evidence and prediction contradict each other.
            Some(best) if best.candidate.is_some_and(|k| weighing.is_disputed(k)) => open,
            // If "nothing is missing" is the most probable explanation, no effect is claimed.
            Some(best) if is_probable(best.candidate) => match best.candidate {
                // The law and the sets that it leads are none of these explanations.
                None if weighing.law_probability() > best.probability => open,
                None => nothing,
                Some(k) if may_be_named(&|named| named == k) => Self::Named(k),
                Some(_) => open,
            },
            Some(_) => {
                let classes = effects.iter().map(|e| e.class).max().unwrap_or(0);
                let class = (1..=classes).find(|&class| weighing.ranking.class_probability(class) > NAMED);
                let is_member = |class: usize, k: usize| {
                    weighing
                        .ranking
                        .effect(Some(k))
                        .is_some_and(|effect| effect.class == class)
                };
                match class {
                    Some(class) if may_be_named(&|k| is_member(class, k)) => Self::Class(class),
                    _ => open,
                }
            }
            None => Self::NothingDetectable,
        }
    }
}
