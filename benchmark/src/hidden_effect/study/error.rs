//! Why a trial cannot be made.

/// Any error of the parts that a trial runs; it is only printed.
pub type StudyError = Box<dyn std::error::Error + Send + Sync>;
