//! A pool of threads that evaluates leases and counts the time it simulates.

use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use shared::exchange::{Lease, WorkResult};
use shared::outcome::{Fault, Outcome};
use tokio::sync::mpsc;

use crate::model::CompiledVariant;

/// Time and number of evaluations, over all threads.
#[derive(Debug, Default)]
pub struct SimulationClock {
    simulated_ns: AtomicU64,
    evaluations: AtomicU64,
}

impl SimulationClock {
    /// Seconds spent simulating, summed over the threads.
    pub fn simulated_s(&self) -> f64 {
        self.simulated_ns.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Evaluations done.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// Mean time of an evaluation [s]; `None` before the first.
    pub fn mean_s(&self) -> Option<f64> {
        let evaluations = self.evaluations();
        (evaluations > 0).then(|| self.simulated_s() / evaluations as f64)
    }
}

/// A pool of threads; results come out of a channel in the order in which they are done.
#[derive(Debug)]
pub struct Evaluator {
    pool: rayon::ThreadPool,
    results: mpsc::UnboundedSender<WorkResult>,
    clock: Arc<SimulationClock>,
}

impl Evaluator {
    /// A pool of `threads` threads and the receiving end of its results.
    ///
    /// # Errors
    /// The operating system refuses the threads.
    pub fn new(
        threads: usize,
        clock: Arc<SimulationClock>,
    ) -> Result<(Self, mpsc::UnboundedReceiver<WorkResult>), rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("simulate-{i}"))
            .build()?;
        let (results, receiver) = mpsc::unbounded_channel();
        Ok((Evaluator { pool, results, clock }, receiver))
    }

    /// Queues an evaluation behind those that wait; a panic of the model is a fault, not a loss.
    pub fn start(&self, lease: Lease, variant: Arc<CompiledVariant>, cancelled: Arc<AtomicBool>) {
        let (results, clock) = (self.results.clone(), self.clock.clone());
        self.pool.spawn_fifo(move || {
            // Once the worker stops, what has not begun is given back instead.
            if cancelled.load(Ordering::Acquire) {
                return;
            }
            let began = Instant::now();
            let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| variant.evaluate(&lease.theta)))
                .unwrap_or_else(|_| Outcome::Fault(Fault { message: "the model panicked".into() }));
            let elapsed = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
            clock.simulated_ns.fetch_add(elapsed, Ordering::Relaxed);
            clock.evaluations.fetch_add(1, Ordering::Relaxed);
            let Lease { lease, calibration, evaluation, .. } = lease;
            // The receiver is gone only when the worker has ended.
            let _ = results.send(WorkResult { lease, calibration, evaluation, outcome });
        });
    }

    /// Waits until what was started before has ended.
    pub fn wait(&self) {
        // A broadcast runs on every thread once it has worked off what it began.
        self.pool.broadcast(|_| ());
    }
}
