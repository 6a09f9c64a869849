//! Why a variant cannot be evaluated here.

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
    /// Histories of a steady-state model.
    #[error("histories: {0} has only a steady state; use kind = \"scm\"")]
    NoHistories(&'static str),
    /// A surface that no wheel can have.
    #[error(transparent)]
    Surface(#[from] scm::Rejection),
    /// A condition names a wheel that does not exist.
    #[error("unknown wheel \"{0}\"")]
    UnknownWheel(String),
    /// The three-dimensional model comes without its settings.
    #[error("kind = \"scm\" comes without its settings")]
    NoSettings,
    /// A model that is not ours comes without its description.
    #[error("a model that is not ours comes without its description")]
    NoDescription,
    /// A variant was asked for by another hash than it has.
    #[error("variant {asked} came with hash {own}: coordinator and worker read it differently")]
    OtherHash {
        /// The hash that it was asked for by.
        asked: String,
        /// The hash that it has here.
        own: String,
    },
}
