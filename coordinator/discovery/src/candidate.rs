//! An effect that may be missing, and what is asked of the model about it.

use statistics::prior::Marginal;

/// An effect that may be missing from the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// The priors of its parameters, in the order in which they follow the base's in theta.
    pub parameters: Vec<Marginal>,
    /// Which of them are strengths; the others shape the effect. Several are the knots of a curve.
    pub strengths: Vec<usize>,
    /// The value of every strength at which the effect is absent.
    pub neutral: f64,
}

impl Candidate {
    /// What is wrong with it, if anything is.
    pub(crate) fn check(&self) -> Result<(), CandidateError> {
        let name = || self.name.clone();
        let parameters = self.parameters.len();
        if self.strengths.is_empty() || self.strengths.iter().any(|k| *k >= parameters) {
            return Err(CandidateError::NoStrength {
                name: name(),
                strengths: self.strengths.clone(),
                parameters,
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
    /// It has no strength, or one that is none of its parameters.
    #[error("candidate {name}: strengths are parameters {strengths:?} of {parameters}")]
    NoStrength {
        /// The candidate.
        name: String,
        /// Indices of the strengths.
        strengths: Vec<usize>,
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
}

/// A parameter vector at which the model is to be asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Which effect is switched on; `None`: the base model.
    pub candidate: Option<usize>,
    /// The base's parameters, then the candidate's.
    pub theta: Vec<f64>,
}
