//! The verdict of a discovery, from the probabilities (step 13).

use crate::probability::DETECTED;
use crate::stages::hypotheses::{FittedLaw, Hypotheses};
use crate::stages::weighing::Weighing;
use crate::task::SearchTask;

/// A class or an effect is named if its probability is higher.
const NAMED: f64 = 0.9;

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
    /// Returns whether the verdict names a missing effect, class or law.
    pub fn is_claim(self) -> bool {
        matches!(self, Self::Named(_) | Self::Class(_) | Self::NotInLibrary)
    }

    /// Derives the verdict from the probabilities. They account for a misfit that remains with the best explanation, so a misfit
    /// does not prevent a name.
    ///
    /// # Arguments
    /// - `law`: the law that passed the cross-validation and explains the misfit. `is_incomplete`: whether the best explanation
    ///   contradicts the data; with a model discrepancy, the declared noise.
    pub(super) fn new(
        task: &SearchTask,
        weighing: &Weighing,
        hypotheses: &Hypotheses,
        law: Option<&FittedLaw>,
        is_incomplete: bool,
    ) -> Self {
        let effects = &weighing.ranking.effects;
        let library = hypotheses.best_of_library(task.library.len());
        let library = library.map_or(0.0, |best| best.log_bayes_factor);
        let is_detected = |log_bayes_factor: f64| log_bayes_factor / weighing.misfit > DETECTED;
        let probability = weighing
            .not_in_library
            .map_or(0.0, |(_, probability)| probability);
        let law = law.filter(|law| is_detected(law.log_bayes_factor - library.max(0.0)));
        // Without a detection in the library, one of many laws may fit by chance; the probability accounts for their number.
        if law.is_some() && probability > if is_detected(library) { 0.5 } else { NAMED } {
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
        let best = effects
            .iter()
            .reduce(|a, b| if b.probability > a.probability { b } else { a });
        match best {
            // Evidence and prediction contradict each other.
            Some(best) if best.candidate.is_some_and(|k| weighing.is_disputed(k)) => Self::Undecided,
            // If "nothing is missing" is the most probable explanation, no effect is claimed.
            Some(best) if best.probability > NAMED || best.candidate.is_none() => {
                best.candidate.map_or(nothing, Self::Named)
            }
            Some(_) => {
                let classes = effects.iter().map(|e| e.class).max().unwrap_or(0);
                let class = (1..=classes).find(|&class| weighing.ranking.class_probability(class) > NAMED);
                // The remaining probability may belong to the effects beside a law, not to the law.
                let is_shared =
                    |law: &FittedLaw| probability + weighing.beside_effects(task, law.law) > NAMED;
                match class {
                    Some(class) => Self::Class(class),
                    None if law.is_some_and(is_shared) => Self::NotInLibrary,
                    None => Self::Undecided,
                }
            }
            None => Self::NothingDetectable,
        }
    }
}
