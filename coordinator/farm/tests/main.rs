//! Tests of the farm without network and store: the rules of leasing, and promises under simulated faults.

mod leasing;
mod simulation;
