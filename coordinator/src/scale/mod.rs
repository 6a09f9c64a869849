//! How many workers an engine should run, and how it is told.
//!
//! A *pilot* is a worker process that an engine starts: a job of Slurm or HyperQueue, a pod of Kubernetes. The engine gets machines,
//! keeps them and gives them back; which evaluation goes where stays the farm's.
//!
//! # Layout
//! - [`policy`]: how many pilots the work is worth. Pure.
//! - [`budget`]: what pilots have cost, and when starting more is in vain. Pure.
//! - [`pilot`]: what every pilot is told, and which there are.
//! - [`engine`]: the engines; `slurm`, `hyperqueue` and `kubernetes` each speak to one of them by its own programs.
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
