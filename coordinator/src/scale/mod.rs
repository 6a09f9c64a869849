//! The number of workers that an engine should run, and the calls of the engine's programs.
//!
//! A *pilot* is a worker process that an engine starts: a job of Slurm or HyperQueue, a pod of Kubernetes. The engine allocates and
//! releases machines; the farm alone distributes evaluations.
//!
//! # Layout
//! - [`policy`]: the number of pilots for the present work. Pure.
//! - [`budget`]: the cost of pilots, and the pauses after pilots that achieve nothing. Pure.
//! - [`pilot`]: the settings of pilots, and the list of present ones.
//! - [`engine`]: the engines; `slurm`, `hyperqueue` and `kubernetes` each make the calls of one engine's programs.
//! - `program`: runs these programs.

pub mod budget;
pub mod engine;
mod hyperqueue;
mod kubernetes;
pub mod pilot;
pub mod policy;
mod program;
mod slurm;

pub use program::ProgramError;
