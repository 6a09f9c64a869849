//! The likelihood: predictions scored against measurements.
//!
//! The errors of the data are independent, or correlated in blocks by common errors: the inadequacy of the model in a
//! condition, the soil of a run, the preparation of a plate test. A block is a small multivariate normal, or t.
//!
//! # Layout
//! - `datum`: a measured value with its noise. `law`: normal or Student's t.
//! - `common_error`: common errors, and the blocks that they create. `spread`: the covariance of a block.
//! - `innovation`: errors that are autocorrelated along the travel of a run.
//! - `error_model`: data, law and common errors together. `density`: their log-density.
//! - `factor`: the factor of a block's covariance; `low_rank_factor`: that of a large block; `common_shift`: a block that needs none. `subset`: the
//!   likelihood of selected data. `kept_parameters`: that of a model with some of the parameters.
//! - `numerical_noise`: the likelihood of a model whose predictions scatter.
//! - `whitening`: residuals and derivatives transformed to independence, for least squares.

mod common_error;
mod common_shift;
mod datum;
mod density;
mod error_model;
mod factor;
mod innovation;
mod kept_parameters;
mod law;
mod low_rank_factor;
mod numerical_noise;
mod spread;
mod subset;
mod whitening;

pub use common_error::{
    CommonError, CommonErrorSize, DISCREPANCY_LEVELS, Discrepancy, MAX_DISCREPANCY, MIN_DISCREPANCY,
    Sensitive, discrepancy_levels,
};
pub use datum::{Datum, ErrorSd, LikelihoodError};
pub use error_model::Likelihood;
pub use innovation::Innovation;
pub use law::ErrorLaw;
pub use whitening::Whitening;
