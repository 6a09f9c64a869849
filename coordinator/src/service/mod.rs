//! Store and farm together: submit, recover, control, grow.
//!
//! # Layout
//! - `handle`: [`Service`], which everybody holds.
//! - `farm_settings`: how the farm leases and verifies.
//! - `recovery`: what a start takes up again.
//! - `submission`: new experiments and calibrations.
//! - `effects`: what users add to the catalogue, and jobs that name it.
//! - `removal`: what is archived or deleted.
//! - `announcement`: what web hooks are told.
//! - `growth`: what is added to a study that is there. `what_if`: studies without some runs.
//! - `stored_calibration`, `study_step`, `finished_study`: what is read from the store.
//! - `compared_models`: the compared models that a study does not go on with. `study_members`: the members of a study. `study_overview`: studies as the page shows them, `overview_cache`: kept.
//! - `study_results`: the files of a study, computed once.

mod announcement;
mod clock;
mod compared_models;
mod effects;
mod error;
mod farm_settings;
mod finished_study;
mod growth;
mod handle;
mod overview_cache;
mod recovery;
mod removal;
mod stored_calibration;
mod study_changes;
mod study_members;
mod study_overview;
mod study_results;
mod study_step;
mod submission;
mod what_if;

pub use error::ServiceError;
pub use farm_settings::{FarmSettings, LEASE_MS, VERIFIED_PERCENT};
pub use finished_study::{finished_calibration, finished_study, search_rounds};
pub use handle::Service;
pub use stored_calibration::{calibration_row, experiment_files, leave_out_archived, stored_status};
pub use study_results::{diagnostics, study_file};
pub use study_step::{finished_search, next_step_of};
