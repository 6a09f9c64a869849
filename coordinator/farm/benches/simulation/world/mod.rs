//! A world for the farm: workers, a network, a store and users, all drawn from one seed.
//!
//! # Layout
//! - [`case`]: the calibrations, each with what it gives when nothing goes wrong.
//! - [`schedule`]: one schedule from its seed: what happens, step by step.
//! - `weather`: how often what goes wrong.
//! - [`request`]: a request that asks for nothing. `worker`: a worker that keeps to the protocol and breaks down.
//! - `coordinator`: the real farm, called as the farm's thread and the store's writer call it.
//! - `ledger`: the simulated store; `issued`: the leases that were given.
//! - `witness`, `leasing`, [`promise`]: what must hold, and who checks it.
//! - [`plant`]: the planted bugs.
//! - [`search`], `tally`: many schedules, and what happened in them.

pub(crate) mod case;
mod coordinator;
mod issued;
mod leasing;
mod ledger;
pub(crate) mod plant;
pub(crate) mod promise;
pub(crate) mod request;
pub(crate) mod schedule;
pub(crate) mod search;
mod tally;
mod weather;
mod witness;
mod worker;
