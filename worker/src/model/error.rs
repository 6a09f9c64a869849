//! Errors of compiling a variant.

use scm::effects::FormError;
use shared::model::ModelError;

/// Why a variant cannot be evaluated here.
#[derive(Debug, thiserror::Error)]
pub enum CompileError {
    /// The variant contradicts itself, or its model cannot express it.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The model of this worker has no form of an effect.
    #[error(transparent)]
    Effect(#[from] FormError),
    /// Histories are requested from a steady-state model.
    #[error("histories: {0} has only a steady state; use kind = \"scm\"")]
    NoHistories(&'static str),
    /// Transients are requested from a model without them.
    #[error(
        "transients: {0} has only a steady state; use kind = \"quasi_static\", \"wong_reece\" or \"scm\""
    )]
    NoTransients(&'static str),
    /// A transient names a run that does not exist.
    #[error("a transient names run {run} of {runs}")]
    UnknownRun {
        /// Position of the run.
        run: usize,
        /// Number of runs.
        runs: usize,
    },
    /// The surface of a wheel is impossible.
    #[error(transparent)]
    Surface(#[from] scm::Rejection),
    /// A condition names a wheel that does not exist.
    #[error("unknown wheel \"{0}\"")]
    UnknownWheel(String),
    /// The settings of the three-dimensional model are missing.
    #[error("kind = \"scm\" comes without its settings")]
    NoSettings,
    /// The description of an external model is missing.
    #[error("a model that is not ours comes without its description")]
    NoDescription,
    /// The hash of a variant differs from the requested one.
    #[error("variant {requested} came with hash {actual}: coordinator and worker read it differently")]
    OtherHash {
        /// The requested hash.
        requested: String,
        /// The hash computed here.
        actual: String,
    },
}
