//! Why a calibration cannot be exported.

/// Why a calibration cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The calibration is a fit that has no draws.
    #[error(
        "calibration {0} has no draws of its posterior: it is a fit or search of a point; --format json has what it found"
    )]
    NoDraws(i64),
    /// A variable has another number of values than its dimensions say.
    #[error("variable {name} has {found} values, its shape {shape:?} asks for {expected}")]
    Shape {
        /// Name of the variable.
        name: String,
        /// Its shape.
        shape: Vec<usize>,
        /// Values that it has.
        found: usize,
        /// Values that it should have.
        expected: usize,
    },
    /// A name that would be a path, where a format makes folders of names.
    #[error("{0:?} is no name of a group or a variable: it must have no / and no \\, and not be . or ..")]
    Name(String),
    /// A group is missing.
    #[error("inference data without a group {0}")]
    Group(&'static str),
    /// A count is beyond what the format can say.
    #[error("{what}: {count} must be at most {most}")]
    Size {
        /// What is counted.
        what: &'static str,
        /// The count.
        count: usize,
        /// The largest that the format can say.
        most: u64,
    },
    /// The Arrow library refuses.
    #[error("arrow: {0}")]
    Arrow(#[from] arrow_schema::ArrowError),
    /// The Parquet library refuses.
    #[error("parquet: {0}")]
    Parquet(#[from] parquet::errors::ParquetError),
}
