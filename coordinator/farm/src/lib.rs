//! The farm: all calibrations in progress and all connected workers, and the assignment of evaluations to workers.
//!
//! # Layout
//! - [`calibration`]: a calibration in progress, which combines sampler, likelihood and leases. Pure.
//! - [`lease`]: the rules of leasing. Pure.
//! - `farm`: [`Farm`]. Pure: the time is an argument, and facts are returned as a list.
//! - `leasing`: the leases for a worker. `work_result`: the effect of its results.
//! - `voting`: [`Voting`], identities in comparisons of answers.
//! - `verification`: the consequences of disagreement between workers, and second leases beside slow ones.
//! - `stepping`: the steps of engines that are due and taken.
//! - [`dispatch`]: the thread of the farm. `compute`: the threads that take steps. `pulse`: the activity of the farm's thread.
//! - `control`: the commands of a user on a calibration.
//! - `demand`: the amount of work.
//! - `lease_numbers`: numbers of leases.
//! - `share`: the division of leases among calibrations.
//! - `seal`: the proof that a result belongs to its question.
//! - `progress`: the speed of a calibration. `finished_share`: how much of it is done. `replay_cause`: why one in progress is replayed.
//! - `worker_record`, `metrics`: records of workers, and counters.

pub mod calibration;
mod compute;
mod control;
mod demand;
pub mod dispatch;
mod farm;
mod finished_share;
pub mod lease;
mod lease_numbers;
mod leasing;
mod metrics;
mod progress;
mod pulse;
mod replay_cause;
mod seal;
mod share;
mod stepping;
mod verification;
mod voting;
mod work_result;
mod worker_record;

pub use control::{Control, ControlError};
pub use farm::Farm;
pub use metrics::{FarmCounters, FarmMetrics};
pub use voting::Voting;
pub use worker_record::WorkerRecord;
