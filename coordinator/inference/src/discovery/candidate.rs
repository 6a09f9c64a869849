//! An effect that may be missing, and what is asked of the model about it.

use crate::prior::Marginal;

/// An effect that may be missing from the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// The priors of its parameters, in the order in which they follow the base's in theta.
    pub parameters: Vec<Marginal>,
    /// Which of them is the strength; the others shape the effect.
    pub strength: usize,
    /// The strength at which the effect is absent.
    pub neutral: f64,
}

impl Candidate {
    /// Whether the neutral strength is an end of the prior's support.
    #[must_use]
    pub fn is_one_sided(&self) -> bool {
        let (lower, upper) = self.parameters[self.strength].support();
        self.neutral <= lower || self.neutral >= upper
    }

    /// What is wrong with it, if anything is.
    pub(super) fn check(&self) -> Result<(), CandidateError> {
        let name = || self.name.clone();
        if self.strength >= self.parameters.len() {
            return Err(CandidateError::NoStrength {
                name: name(),
                strength: self.strength,
                parameters: self.parameters.len(),
            });
        }
        if !self.neutral.is_finite() {
            return Err(CandidateError::Neutral {
                name: name(),
                value: self.neutral,
            });
        }
        Ok(())
    }
}

/// A candidate that cannot be looked for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CandidateError {
    /// The strength is none of its parameters.
    #[error("candidate {name}: strength is parameter {strength} of {parameters}")]
    NoStrength {
        /// The candidate.
        name: String,
        /// Index of the strength.
        strength: usize,
        /// Number of its parameters.
        parameters: usize,
    },
    /// The neutral strength is NaN or infinite.
    #[error("candidate {name}: neutral strength {value} is not finite")]
    Neutral {
        /// The candidate.
        name: String,
        /// The strength.
        value: f64,
    },
    /// There is no parameter to fit.
    #[error("the base model has no free parameter")]
    NoBase,
    /// Noise that is to be inferred moves with every model; this version compares models at known noise.
    #[error("datum {datum} has a noise sd that is to be inferred; discovery needs known ones")]
    InferredNoise {
        /// Index of the datum.
        datum: usize,
    },
}

/// A parameter vector at which the model is to be asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Which effect is switched on; `None`: the base model.
    pub candidate: Option<usize>,
    /// The base's parameters, then the candidate's.
    pub theta: Vec<f64>,
}
