//! Identity and settings of a worker.

use std::sync::Arc;

use super::limits::WorkerLimits;
use crate::external::allowed::AllowedModels;

/// Identity and settings of a worker.
#[derive(Debug, Clone)]
pub struct PullSettings {
    /// Name of this worker process, fresh at every start.
    pub name: String,
    /// The queue's job that started the worker, such as `slurm 1234_5`.
    pub queue_job: Option<String>,
    /// Number of threads that simulate.
    pub threads: usize,
    /// The external models that it may run.
    pub models: Arc<AllowedModels>,
    /// The limits of its service.
    pub limits: WorkerLimits,
}
