//! Kernel densities of one parameter (`marginal`) and of two (`joint`).

mod joint;
mod kernel;
mod marginal;

pub use joint::{highest_density_levels, joint_density};
pub use marginal::{bandwidth, density};
