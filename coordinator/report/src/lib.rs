//! Reports: the sentences and files of a study, from the numbers of `result`: flags, story, `summary.json`, HTML report, terminal text.
//!
//! Everything here is a pure function of a [`result::FinishedCalibration`], or of the [`result::Study`] that it belongs to.
//!
//! # Layout
//! - [`diagnosis`]: diagnostics with their findings and flags. [`flag`]: warnings in words.
//! - [`provenance`]: inputs and versions of a calibration, and its results in sentences.
//! - [`story`]: what is wrong, what is missing, what to do next.
//! - [`summary`]: `summary.json`. [`overview`]: a study as the page shows it.
//! - [`terminal`]: text for a terminal. [`document`]: one HTML document with everything.
//! - [`study_file`]: the result files of a study.

pub mod diagnosis;
pub mod document;
#[cfg(test)]
#[path = "../../result/src/fixture.rs"]
pub mod fixture;
pub mod flag;
pub mod overview;
pub mod provenance;
pub mod story;
pub mod study_file;
pub mod summary;
pub mod terminal;

pub use flag::model_limit::model_limits;
pub use overview::{MemberOverview, StudyFlag, StudyListItem, StudyOverview, StudyVerdict};
pub use provenance::Provenance;
pub use story::Story;
pub use study_file::{CalibrationFile, StudyFile};
pub use summary::calibration::CalibrationSummary;
pub use summary::study::StudySummary;
