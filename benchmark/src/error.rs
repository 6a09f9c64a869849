//! The error of a study.

/// Any error of the parts that a study runs; it is only printed.
pub type StudyError = Box<dyn std::error::Error + Send + Sync>;
