//! Tests of the farm without network and store: the rules of leasing, several workers that compute wrongly, steps of engines on other
//! threads, and promises under simulated faults.

mod leasing;
mod liars;
mod simulation;
mod steps;
