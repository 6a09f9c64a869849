//! Results: the numbers of a calibration and of a study, from the stored facts: tables, diagnostics, errors, figures.
//!
//! Everything here is a pure function of a [`FinishedCalibration`], or of the [`Study`] that it belongs to. No decision reads a
//! holdout row.
//!
//! # Layout
//! - [`finished_calibration`], [`study`]: the inputs of the results. [`study_member`]: a calibration or search of a study.
//! - [`study_failure`]: the reason of a failure, with advice.
//! - [`table`]: model against measurement, errors, intervals, the posterior's draws.
//! - [`parameter_summary`], [`point_estimate`], [`error_summary`], [`holdout_summary`], [`coverage_summary`]: entries of summaries.
//! - [`diagnostics`]: how far the posterior can be trusted. [`flag`]: a warning.
//! - [`model_comparison`]: the models that a job compares, by evidence and by prediction.
//! - [`validation`]: the levels of a factor, each predicted from the others.
//! - [`response_surface`]: the model's outputs as polynomials of its parameters, over the posterior.
//! - [`discovery`]: the searches for missing effects.
//! - [`figure`]: the numbers of the source paper's figures.
//! - [`rig`]: offsets of sessions, tarings and operators that repeats show.
//! - [`words`]: numbers, units, probabilities and citations as people read them.

pub mod coverage_summary;
pub mod diagnostics;
pub mod discovery;
pub mod error_summary;
pub mod figure;
pub mod finished_calibration;
#[cfg(test)]
extern crate self as result;
#[cfg(test)]
pub mod fixture;
pub mod flag;
pub mod holdout_summary;
pub mod model_comparison;
pub mod parameter_summary;
pub mod point_estimate;
pub mod response_surface;
pub mod rig;
pub mod study;
pub mod study_failure;
pub mod study_member;
pub mod table;
pub mod validation;
pub mod words;

pub use diagnostics::Diagnostics;
pub use discovery::{DiscoveryRound, DiscoverySummary};
pub use figure::{CalibrationFigures, ChannelHistory, MeasuredSeries, ModelSeries};
pub use finished_calibration::{FinishedCalibration, Outcome, SampledPosterior, first_population, likeliest};
pub use flag::{Flag, FlagKind};
pub use model_comparison::{ComparedModel, LeftOutBy, ModelComparison};
pub use parameter_summary::ParameterSummary;
pub use point_estimate::PointEstimate;
pub use response_surface::{ResponseSurface, RunSurface, SurfaceError, SurfaceParameter};
pub use rig::{RepeatOffset, RepeatOffsets, RepeatedQuantity, repeat_offsets};
pub use study::Study;
pub use study_failure::StudyFailure;
pub use study_member::{Rejections, StudyMember};
pub use table::comparison::Comparison;
pub use table::errors::{ChannelError, ErrorTable};
pub use table::fixed_sigma::{FixedSigma, FixedSigmas, SigmaSource};
pub use table::group::{ErrorGroup, GroupBy, GroupError};
pub use table::holdout_errors::HoldoutErrors;
pub use table::holdout_group::HoldoutGroup;
pub use table::interpolation::{InterpolatedOver, Interpolations};
pub use table::mixture::Component;
pub use table::posterior::PosteriorTable;
pub use table::prediction::PredictionRow;
pub use table::predictive::{NewMeasurement, NewMeasurements, Predictive};
pub use table::refusal::Refusal;
pub use table::row::ComparisonRow;
pub use words::campaign::CampaignWords;
pub use words::data_channel::{BevameterTest, DataChannel};
pub use words::number;
