//! A candidate: an effect that may be missing from the model.

use statistics::prior::Marginal;

/// An effect that may be missing from the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Name, by which other candidates exclude it.
    pub name: String,
    /// The priors of its parameters, which follow the base's in theta.
    pub parameters: Vec<Marginal>,
    /// Indices of the parameters that are strengths; the others shape the effect. Several strengths are the knots of a curve. A
    /// candidate without parameters is a switch: another model with the same parameters.
    pub strengths: Vec<usize>,
    /// The value of every strength at which the effect is absent.
    pub neutral: f64,
    /// Names of the candidates with which it makes no combination.
    pub excludes: Vec<String>,
    /// Name of the family. Its candidates are laws of one quantity under different conditions, and may explain together what none
    /// explains alone.
    pub family: Option<String>,
    /// Names of the quantities that it changes. An effect and a law of one quantity may be factors of one law of two variables.
    pub quantities: Vec<String>,
    /// Name of the candidate whose parameter has a limit here that its prior does not reach. Both change one parameter of the model, so
    /// they belong to one class.
    pub limit_of: Option<String>,
    /// Whether the low-fidelity model has this candidate.
    pub has_low_fidelity: bool,
}

impl Candidate {
    /// Makes a candidate that is absent where its strengths are 0, combines with every other one, belongs to no family and states no quantity.
    #[must_use]
    pub fn new(name: impl Into<String>, parameters: Vec<Marginal>, strengths: Vec<usize>) -> Self {
        Self {
            name: name.into(),
            parameters,
            strengths,
            neutral: 0.0,
            excludes: Vec::new(),
            family: None,
            quantities: Vec::new(),
            limit_of: None,
            has_low_fidelity: false,
        }
    }

    /// Returns whether the candidate is another model with the same parameters.
    #[must_use]
    pub fn is_switch(&self) -> bool {
        self.parameters.is_empty()
    }

    /// Returns whether both candidates may stand in one combination.
    pub(crate) fn combines_with(&self, candidate: &Self) -> bool {
        !self.excludes.contains(&candidate.name) && !candidate.excludes.contains(&self.name)
    }

    /// Returns whether both candidates change one quantity.
    pub(crate) fn shares_quantity(&self, candidate: &Self) -> bool {
        self.quantities
            .iter()
            .any(|name| candidate.quantities.contains(name))
    }

    /// Returns whether both candidates change the same parameter of the model.
    #[must_use]
    pub fn is_same_parameter(&self, candidate: &Self) -> bool {
        let is_limit = |limit: &Self, of: &Self| limit.limit_of.as_ref() == Some(&of.name);
        self.name == candidate.name || is_limit(self, candidate) || is_limit(candidate, self)
    }

    /// Checks the strengths and the neutral value.
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
        /// Name of the candidate.
        name: String,
        /// Indices of the strengths.
        strengths: Vec<usize>,
        /// Number of parameters of the candidate.
        parameters: usize,
    },
    /// The neutral strength is NaN or infinite.
    #[error("candidate {name}: neutral strength {value} is not finite")]
    Neutral {
        /// Name of the candidate.
        name: String,
        /// The neutral strength as given.
        value: f64,
    },
    /// The base model has no free parameter.
    #[error("the base model has no free parameter")]
    NoBase,
}
