//! An effect that may be missing.

use statistics::prior::Marginal;

/// An effect that may be missing from the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// The priors of its parameters, which follow the base's in theta.
    pub parameters: Vec<Marginal>,
    /// Which of them are strengths; the others shape the effect. Several are the knots of a curve. A candidate without parameters is a
    /// switch: another model with the same parameters.
    pub strengths: Vec<usize>,
    /// The value of every strength at which the effect is absent.
    pub neutral: f64,
    /// Names of the candidates with which it makes no combination.
    pub excludes: Vec<String>,
    /// Candidates of one family are laws of one quantity, each for other conditions: they may explain together what none does alone.
    pub family: Option<String>,
    /// Whether the model's companion has a form of it.
    pub has_companion: bool,
}

impl Candidate {
    /// Whether it is another model with the same parameters.
    #[must_use]
    pub fn is_switch(&self) -> bool {
        self.parameters.is_empty()
    }

    /// Whether the two make a combination.
    pub(crate) fn combines_with(&self, other: &Self) -> bool {
        !self.excludes.contains(&other.name) && !other.excludes.contains(&self.name)
    }

    /// Checks strengths and neutral value.
    pub(crate) fn check(&self) -> Result<(), CandidateError> {
        let name = || self.name.clone();
        let parameters = self.parameters.len();
        if self.strengths.is_empty() != self.is_switch() || self.strengths.iter().any(|k| *k >= parameters) {
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

/// Why a search cannot begin.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CandidateError {
    /// A candidate has no strength, or a strength that is not among its parameters.
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
    /// The base model has no free parameter.
    #[error("the base model has no free parameter")]
    NoBase,
}
