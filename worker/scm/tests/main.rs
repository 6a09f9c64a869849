//! Checks of the physics with closed forms, invariants, a brute-force integrator and another implementation.

mod bevameter;
mod brute_force;
mod closed_forms;
mod crossing;
mod effects;
mod grousers;
mod invariants;
mod quadrature;
mod reference_table;
mod rejections;
mod rft;
mod scene;
mod spatial;
mod steady_runs;
mod support;
mod validation;
mod wong_reece;
