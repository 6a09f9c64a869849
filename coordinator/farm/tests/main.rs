//! The farm without network and store: its rules of leasing, and promises under simulated faults.

mod leasing;
mod simulation;
