//! Who a worker is and how it works.

use std::sync::Arc;

use super::limits::WorkerLimits;
use crate::external::allowed::AllowedModels;

/// Who the worker is and how it works.
#[derive(Debug, Clone)]
pub struct PullSettings {
    /// Name of this worker process, fresh at every start.
    pub name: String,
    /// The job of a queue that started it, as in `slurm 1234_5`.
    pub queue_job: Option<String>,
    /// Threads that simulate.
    pub threads: usize,
    /// The models that are not ours that it runs.
    pub models: Arc<AllowedModels>,
    /// How long it serves.
    pub limits: WorkerLimits,
}
