//! The farm: all calibrations in progress and all known workers; which worker evaluates what.
//!
//! # Layout
//! - [`calibration`]: a calibration in progress: the one place where sampler, likelihood and leases meet. Pure.
//! - [`lease`]: the rules of leasing. Pure.
//! - `state`: [`Farm`]. Pure: the clock comes as an argument and facts go out as a list.
//! - `leasing`: what a worker is given.
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
pub mod lease;
mod lease_numbers;
mod leasing;
mod metrics;
mod progress;
mod pulse;
mod seal;
mod share;
mod state;
mod verification;
mod worker_record;

pub use control::{Control, ControlError};
pub use metrics::{FarmCounters, FarmMetrics};
pub use state::Farm;
pub use worker_record::WorkerRecord;
