//! Reasons for which a calibration cannot be exported.

/// A reason for which a calibration cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The calibration is a fit that has no draws.
    #[error(
        "calibration {0} has no draws of its posterior: it is a fit or search of a point; --format json has what it found"
    )]
    NoDraws(i64),
    /// The number of a variable's values differs from the product of its dimensions.
    #[error("variable {name} has {actual} values, its shape {shape:?} asks for {expected}")]
    Shape {
        /// Name of the variable.
        name: String,
        /// Lengths of the variable's dimensions.
        shape: Vec<usize>,
        /// Number of the variable's values.
        actual: usize,
        /// Number of values that its dimensions require.
        expected: usize,
    },
    /// A name would be a path in a format that makes folders of names.
    #[error("{0:?} is no name of a group or a variable: it must have no / and no \\, and not be . or ..")]
    Name(String),
    /// A group is missing.
    #[error("inference data without a group {0}")]
    Group(&'static str),
    /// A count exceeds the maximum of the format.
    #[error("{what}: {count} must be at most {max}")]
    Size {
        /// The counted quantity.
        what: &'static str,
        /// The count.
        count: usize,
        /// The largest count of the format.
        max: u64,
    },
    /// An archive cannot be written.
    #[error("archive: {0}")]
    Archive(String),
    /// Project Chrono cannot express the model.
    #[error("{0}")]
    Chrono(String),
    /// Error of the Arrow library.
    #[error("arrow: {0}")]
    Arrow(#[from] arrow_schema::ArrowError),
    /// Error of the Parquet library.
    #[error("parquet: {0}")]
    Parquet(#[from] parquet::errors::ParquetError),
}

impl From<zip::result::ZipError> for ExportError {
    fn from(error: zip::result::ZipError) -> Self {
        ExportError::Archive(error.to_string())
    }
}
