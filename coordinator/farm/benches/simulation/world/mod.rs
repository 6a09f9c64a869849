//! The simulated world of the farm: workers, a network, a store and users, all drawn from one seed.
//!
//! # Layout
//! - [`case`]: the calibrations, each with its results in a run without faults.
//! - [`schedule`]: one schedule from its seed, step by step.
//! - `weather`: the probabilities of faults.
//! - [`request`]: a request that asks for nothing. `worker`: a worker that keeps to the protocol and breaks down.
//! - `coordinator`: the real farm, called as the farm's thread and the store's writer call it.
//! - [`ledger`]: the simulated store; `issued`: the leases that were given.
//! - `witness`, `leasing`, [`promise`]: the promises, and their checks.
//! - [`plant`]: the planted bugs.
//! - [`search`], `tally`: many schedules, and the counts of their events.

pub(crate) mod case;
mod coordinator;
mod issued;
mod leasing;
pub(crate) mod ledger;
pub(crate) mod plant;
pub(crate) mod promise;
pub(crate) mod request;
pub(crate) mod schedule;
pub(crate) mod search;
mod tally;
mod weather;
mod witness;
mod worker;
