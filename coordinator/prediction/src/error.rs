//! The reason why there is no prediction.

use shared::file::FileError;

/// The reason why there is no prediction or decision.
#[derive(Debug, thiserror::Error)]
pub enum PredictionError {
    /// A plan or a file is malformed.
    #[error(transparent)]
    File(#[from] FileError),
    /// The request asks for something that cannot be.
    #[error("{0}")]
    Request(String),
    /// The calibration is a fit without draws, from which no interval follows.
    #[error("calibration {0} has no draws of a posterior: a fit alone has no distribution to predict with")]
    NoDraws(i64),
    /// The posterior of a calibration has no draws with predictions.
    #[error("calibration {0} has no stored draws with predictions of its runs, which predictions start from")]
    NoStoredDraws(i64),
    /// The model cannot be evaluated.
    #[error("{0}")]
    Model(String),
}
