//! Why a model cannot be set up.

use crate::parameters::BoundsError;

/// Why a model cannot be set up. A variant with a text holds the whole sentence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// An unknown word, with the nearest known one.
    #[error("{0}")]
    Unknown(String),
    /// A key or its value breaks a rule.
    #[error("{0}")]
    Invalid(String),
    /// A parameter lies outside its bounds.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// A parameter that the model needs has neither prior nor value.
    #[error("parameter {0} has neither a prior nor a fixed value")]
    Unset(String),
    /// Something is missing or stated twice.
    #[error("{0}")]
    Incomplete(String),
    /// The forward model cannot express the request, or the request would have no effect.
    #[error("{0}")]
    Inexpressible(String),
    /// The file of a received effect cannot be read.
    #[error("effect {name}: {error}")]
    Effect {
        /// Name of the effect.
        name: String,
        /// The mistake in its file.
        error: formula::EffectError,
    },
    /// The name of a received effect differs from the name in its file.
    #[error("effect {in_file} came as {sent}")]
    EffectName {
        /// Name in the file.
        in_file: String,
        /// The name in the message.
        sent: String,
    },
}

impl From<ModelError> for String {
    fn from(error: ModelError) -> Self {
        error.to_string()
    }
}
