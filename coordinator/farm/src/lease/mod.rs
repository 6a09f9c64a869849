//! The rules of leasing: who may claim, renew, complete, give back; what expiry and faults cost.
//!
//! Pure: the caller brings the clock and the lease numbers. One [`LeaseQueue`] holds the evaluations of a
//! calibration that are asked for at present.
//!
//! A lost lease makes its evaluation a *suspect*: it is then leased alone, to a worker that holds nothing else and
//! reports that it begins before it does. So a parameter vector that kills its worker is found out, and those that were
//! merely with it are not blamed. Only the loss of a lease that was reported as started is a failed attempt: whoever dies,
//! or is cut off, has done nothing to the evaluations that wait in its hands. An evaluation that is lost twenty times in a row
//! before anybody begins it is told to the caller: whatever ends its workers, leasing it on ends more of them.
//!
//! # Layout
//! - `queue`: [`LeaseQueue`].
//! - `failure`: what claims are made of and what comes of them.

mod failure;
mod queue;

pub use failure::{
    Claimant, Completion, Expired, LeaseFailure, MAX_ATTEMPTS, MAX_UNSTARTED, NewClaim, SlowLease,
};
pub use queue::LeaseQueue;
