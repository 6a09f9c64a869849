//! The service: store and farm together, to submit, recover, control and extend calibrations.
//!
//! # Layout
//! - `handle`: [`Service`].
//! - `farm_settings`: settings of leases and verification.
//! - `recovery`: resumes calibrations at a start.
//! - `background`: computations beside the threads that answer requests.
//! - `submission`: new experiments and calibrations.
//! - `effects`: effects that users add to the catalogue, and jobs that name them.
//! - `library`: laws that every later search tries, with what the studies say of them.
//! - `removal`: archives and deletes studies. `withdrawal`: takes back what was added to a study, and keeps what people say of it.
//! - `announcement`: posts to web hooks.
//! - `growth`: additions to an existing study. `what_if`: studies without some runs.
//! - `stored_calibration`, `study_step`, `finished_study`: values that are read from the store.
//! - `study_members`: the members of a study.
//! - `results`: the texts about studies and calibrations, kept in the `result_cache`. `study_overview`: studies for the page.
//! - `follow`: further runs of a campaign while it lasts; `campaign`: its last answer, for those who watch.
//! - `job_check`: a job before it is submitted, with its cost.
//! - `predictions`: conditions of one's own and decisions; `simulation`: their simulations in this process.
//! - `recording`: recordings that are followed.
//! - `study_changes`: notifications of changes of studies.

mod announcement;
mod background;
mod campaign;
mod clock;
mod effects;
mod error;
mod farm_settings;
mod finished_study;
mod follow;
mod growth;
mod handle;
mod job_check;
mod library;
mod predictions;
pub(crate) mod recording;
mod recovery;
mod removal;
mod result_cache;
mod results;
mod simulation;
mod stored_calibration;
mod study_changes;
mod study_members;
mod study_overview;
mod study_step;
mod submission;
mod what_if;
mod withdrawal;

pub(crate) use background::in_background;
pub use error::ServiceError;
pub use farm_settings::{FarmSettings, LEASE_MS, VERIFIED_PERCENT};
pub use handle::Service;
pub use job_check::{JobCheck, NewCheck};
