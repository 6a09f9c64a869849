//! Tables, summary, flags and report of a calibration, from what the store kept.
//!
//! Everything here is a pure function of an [`FinishedCalibration`], or of the [`Study`] that it belongs to; the decisions it states read no holdout row.

mod baseline;
mod comparison;
mod coverage;
mod csv;
pub mod diagnostics;
pub mod discovery;
mod entangled;
mod errors;
pub mod figure;
mod finished_calibration;
mod flags;
mod group;
mod level;
mod point_estimate;
mod predictive;
mod readings;
pub mod report;
mod settling;
mod study;
mod summary;
pub mod terminal;

pub use comparison::{Comparison, ComparisonRow};
pub use csv::PosteriorTable;
pub use diagnostics::Diagnostics;
pub use discovery::{DiscoverySummary, Round};
pub use errors::{ChannelError, ErrorTable};
pub use figure::{ChannelHistory, Figures, ModelSeries, Series};
use finished_calibration::prior_mean;
pub use finished_calibration::{FinishedCalibration, first_population, likeliest};
pub use flags::Flag;
pub use group::{ErrorGroup, GroupError};
pub use point_estimate::PointEstimate;
pub use predictive::Predictive;
pub use study::Study;
pub use summary::{CalibrationSummary, ParameterSummary, Summary};
