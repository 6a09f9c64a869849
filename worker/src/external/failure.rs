//! Failures of external models.

use shared::outcome::ParameterRejection;

/// Why an external model returns no channels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ExternalFailure {
    /// The model refuses, or an answer is no number: a property of the parameters.
    Refused(ParameterRejection),
    /// The model broke down: the parameters are at fault if it answers for others, else the machine.
    Broke(ParameterRejection),
    /// The machine failed, or the model breaks the agreement with the job.
    Machine(String),
}

impl ExternalFailure {
    /// Creates the failure of a model that refuses a run.
    pub(crate) fn refused(kind: &str, run: usize, message: String) -> Self {
        ExternalFailure::Refused(rejection(kind, run, message))
    }

    /// Creates the failure of a model that broke down, probably at a run.
    pub(crate) fn broke(kind: &str, run: usize, message: String) -> Self {
        ExternalFailure::Broke(rejection(kind, run, message))
    }
}

fn rejection(kind: &str, run: usize, message: String) -> ParameterRejection {
    ParameterRejection {
        kind: kind.to_owned(),
        condition: run as u32,
        message,
    }
}
