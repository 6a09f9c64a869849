//! Tables, summary, flags and report of a calibration, from what the store kept.
//!
//! Everything here is a pure function of a [`FinishedCalibration`], or of the [`Study`] that it belongs to; the decisions it
//! states read no holdout row.
//!
//! # Layout
//! - `finished_calibration`, `study`: what the results are made from. `study_file`: the files that a study ends with.
//! - `table`: model against measurement, errors, intervals, the posterior's draws.
//! - [`diagnostics`]: how far the posterior can be trusted. `flag`: warnings in words.
//!   `diagnosis`: both, computed once.
//! - `model_comparison`: the models that a job compares, by evidence and by prediction.
//! - [`validation`]: the levels of a factor, each predicted from the others.
//! - `overview`, `study_member`: a study as the page shows it. `study_failure`: why it failed.
//! - `summary`: `summary.json`. `discovery`: its block on missing effects.
//! - [`figure`]: the numbers of the source paper's figures.
//! - `provenance`: how a calibration came about, and what it reached in sentences.
//! - [`story`]: what is wrong, what is missing, what to do next.
//! - [`report`]: one HTML document with everything. [`terminal`]: text for a terminal.
//! - `words`: numbers, units, probabilities and citations as people read them.

mod diagnosis;
pub mod diagnostics;
pub mod discovery;
pub mod figure;
mod finished_calibration;
#[cfg(test)]
mod fixture;
mod flag;
mod model_comparison;
mod overview;
mod provenance;
pub mod report;
pub mod story;
mod study;
mod study_failure;
mod study_file;
mod study_member;
mod summary;
mod table;
pub mod terminal;
pub mod validation;
mod words;

pub use diagnostics::Diagnostics;
pub use discovery::{DiscoveryRound, DiscoverySummary};
pub use figure::{CalibrationFigures, ChannelHistory, MeasuredSeries, ModelSeries};
pub use finished_calibration::{FinishedCalibration, first_population, likeliest};
pub use flag::kind::{Flag, FlagKind};
pub use flag::model_limit::model_limits;
pub use model_comparison::{ComparedModel, LeftOutBy, ModelComparison};
pub use overview::{MemberOverview, StudyFlag, StudyListItem, StudyOverview, StudyVerdict};
pub use provenance::Provenance;
pub use story::Story;
pub use study::Study;
pub use study_failure::StudyFailure;
pub use study_file::StudyFile;
pub use study_member::{Rejections, StudyMember};
pub use summary::calibration::CalibrationSummary;
pub use summary::parameter::ParameterSummary;
pub use summary::point_estimate::PointEstimate;
pub use summary::study::StudySummary;
pub use table::comparison::Comparison;
pub use table::errors::{ChannelError, ErrorTable};
pub use table::fixed_sigma::{FixedSigma, FixedSigmas, SigmaSource};
pub use table::group::{ErrorGroup, GroupBy, GroupError};
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
