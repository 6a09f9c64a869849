//! The hidden truth of an experiment, by the candidates of its search.

use discovery::SearchTask;

use super::laws::HiddenLaw;
use crate::error::StudyError;

/// The hidden truth of an experiment: effects of the library, a law outside it, or both.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The effects, by their indices in the library.
    pub effects: Vec<usize>,
    pub law: Option<&'static HiddenLaw>,
}

impl Truth {
    /// # Arguments
    /// - `hidden`: names of effects and of at most one law.
    pub fn new(hidden: &[String], task: &SearchTask) -> Result<Self, StudyError> {
        let mut truth = Self {
            effects: Vec::new(),
            law: None,
        };
        for name in hidden {
            match task.library.iter().position(|candidate| candidate.name == *name) {
                Some(effect) => truth.effects.push(effect),
                None => {
                    let law = HiddenLaw::find(name);
                    truth.law = Some(law.ok_or(format!("\"{name}\" is neither in the library nor a law"))?);
                }
            }
        }
        Ok(truth)
    }

    /// Returns the only thing that is hidden: an effect of the library, or a law as the inner `None`.
    pub fn single(&self) -> Option<Option<usize>> {
        match (self.effects.as_slice(), self.law) {
            ([effect], None) => Some(Some(*effect)),
            ([], Some(_)) => Some(None),
            _ => None,
        }
    }

    pub fn is_nothing(&self) -> bool {
        self.effects.is_empty() && self.law.is_none()
    }

    /// Returns whether a dependence that a search found has the quantity of the hidden law.
    pub fn has_quantity(&self, found: &str) -> bool {
        self.law.is_some_and(|law| law.has_quantity(found))
    }

    /// Returns whether a dependence that a search found has the quantity of the hidden law and a variable of it.
    pub fn has_dependence(&self, found: &str) -> bool {
        self.law.is_some_and(|law| law.dependences.contains(&found))
    }

    /// Returns whether a claim of this dependence is right. One variable cannot describe a law of two, of which only the quantity counts.
    pub fn accepts_law(&self, found: &str) -> bool {
        let is_of_two = self.law.is_some_and(|law| law.dependences.len() > 1);
        self.has_dependence(found) || (is_of_two && self.has_quantity(found))
    }
}
