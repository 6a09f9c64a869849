//! Reasons for which a unit has no result.

/// A reason for which a unit has no result.
#[derive(Debug, thiserror::Error)]
pub(crate) enum UnitError {
    /// The resources cannot be read.
    #[error("{path}: {reason}")]
    Resources {
        /// The file.
        path: String,
        /// Why it cannot be read.
        reason: String,
    },
    /// The simulator has another file's description.
    #[error("instantiation token \"{0}\" is not that of the model in the resources")]
    Token(String),
    /// This machine or program cannot compute the model.
    #[error("{0}")]
    Model(String),
    /// A variable is not there, or cannot be set.
    #[error("there is no {what} with value reference {reference}")]
    Variable {
        /// The kind of the variable.
        what: &'static str,
        /// Its value reference.
        reference: u32,
    },
    /// A value is out of bounds.
    #[error("{name} {value}{unit} must {bound}")]
    Bound {
        /// Name of the variable.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its unit after a space, or nothing.
        unit: &'static str,
        /// The bound.
        bound: String,
    },
    /// The model refuses the condition.
    #[error("the model refuses the condition at {refused} of {draws} draws: {first}")]
    Refused {
        /// Number of draws at which it refuses.
        refused: usize,
        /// Number of draws.
        draws: usize,
        /// The first refusal.
        first: String,
    },
}
