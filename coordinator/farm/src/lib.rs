//! The farm: all calibrations in progress and all known workers; which worker evaluates what.
//!
//! # Layout
//! - [`calibration`]: a calibration in progress: the one place where sampler, likelihood and leases meet. Pure.
//! - [`lease`]: the rules of leasing. Pure.
//! - `farm`: [`Farm`]. Pure: the clock comes as an argument and facts go out as a list.
//! - `leasing`: what a worker is given. `work_result`: what becomes of its results.
//! - `verification`: what follows where workers disagree, and who is asked beside a slow one.
//! - [`dispatch`]: gives it a thread. `pulse`: what that thread is doing.
//! - `control`: the commands of a user on a calibration.
//! - `demand`: how much work there is.
//! - `lease_numbers`: numbers of leases.
//! - `share`: how calibrations share what a worker takes.
//! - `seal`: binds a result to what was asked of whom.
//! - `progress`: how fast a calibration goes.
//! - `worker_record`, `metrics`: what is known of workers, and counted.

pub mod calibration;
mod control;
mod demand;
pub mod dispatch;
mod farm;
pub mod lease;
mod lease_numbers;
mod leasing;
mod metrics;
mod progress;
mod pulse;
mod seal;
mod share;
mod verification;
mod work_result;
mod worker_record;

pub use control::{Control, ControlError};
pub use farm::Farm;
pub use metrics::{FarmCounters, FarmMetrics};
pub use worker_record::WorkerRecord;
