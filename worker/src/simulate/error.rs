//! Errors of forward runs.

use shared::file::FileError;

/// Why there are no forward runs.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// A file cannot be used.
    #[error(transparent)]
    File(#[from] FileError),
    /// The model rejects the parameters.
    #[error("{what} {name}: the model rejects these parameters: {message}")]
    Rejected {
        /// A run of the wheel, or a test of the bevameter.
        what: &'static str,
        /// Name of the run or test.
        name: String,
        /// Quantity, value, unit, bound.
        message: String,
    },
    /// A history cannot be brought to a regular interval.
    #[error("history: {0}")]
    History(#[from] signal::SignalError),
    /// A table cannot be built.
    #[error("table: {0}")]
    Table(#[from] csv::Error),
    /// The result cannot be written.
    #[error("{path}: {source}")]
    Write {
        /// Path of the file.
        path: String,
        /// The operating system's reason.
        source: std::io::Error,
    },
}
