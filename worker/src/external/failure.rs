//! Why a model that is not ours gives no channels.

use shared::outcome::ParameterRejection;

/// Why a model that is not ours gives no channels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ExternalFailure {
    /// It says so itself, or an answer is no number: a fact about the parameters.
    Refused(ParameterRejection),
    /// It broke down: the parameters' fault where it answers for others, else the machine's.
    Broke(ParameterRejection),
    /// The machine, or what is agreed between the job and the model.
    Machine(String),
}

impl ExternalFailure {
    /// It refuses a run.
    pub(crate) fn refused(kind: &str, run: usize, message: String) -> Self {
        ExternalFailure::Refused(rejection(kind, run, message))
    }

    /// It broke down at a run, as far as is known.
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
