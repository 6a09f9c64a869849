//! Why a model cannot be set up.

use crate::parameters::BoundsError;

/// Why a model cannot be set up. Where a variant holds a text, it is the whole sentence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A word that is not known, with the nearest known.
    #[error("{0}")]
    Unknown(String),
    /// A key or its value breaks a rule.
    #[error("{0}")]
    Invalid(String),
    /// A parameter lies outside its bounds.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// A parameter that the model needs is not given.
    #[error("parameter {0} has neither a prior nor a fixed value")]
    Unset(String),
    /// Something is missing, or is given twice.
    #[error("{0}")]
    Incomplete(String),
    /// The forward model cannot express what is asked, or it would have no effect.
    #[error("{0}")]
    Inexpressible(String),
    /// An effect was sent that cannot be read.
    #[error("effect {name}: {error}")]
    Effect {
        /// Its name.
        name: String,
        /// What is wrong with its file.
        error: formula::EffectError,
    },
    /// An effect was sent under another name than its file has.
    #[error("effect {own} came as {sent}")]
    EffectName {
        /// The name in its file.
        own: String,
        /// The name under which it was sent.
        sent: String,
    },
}

impl From<ModelError> for String {
    fn from(error: ModelError) -> Self {
        error.to_string()
    }
}
