//! The rules of leasing: who may claim, renew, complete and return an evaluation, and the cost of expiry and faults.
//!
//! This module is pure: the caller passes the time and the lease numbers. One [`LeaseQueue`] holds the evaluations of a calibration's
//! present round.
//!
//! A lost lease makes its evaluation a *suspect*: it is then leased alone, to a worker that holds nothing else and reports the start before
//! it begins. This finds a parameter vector that kills its worker, without blaming others that the worker held. Only the loss of a lease
//! that was reported as started is a failed attempt, because a worker that dies has not touched the evaluations that wait. An evaluation
//! that is lost twenty times in a row before its start is reported to the caller: more leases would only end more workers.
//!
//! # Layout
//! - `queue`: [`LeaseQueue`].
//! - `failure`: claims and their outcomes.

mod failure;
mod queue;

pub use failure::{
    Claimant, Completion, Expired, LeaseFailure, MAX_ATTEMPTS, MAX_UNSTARTED, NewClaim, SlowLease,
};
pub use queue::LeaseQueue;
