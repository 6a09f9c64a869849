//! A pool of threads that evaluates leases and counts the time it simulates.

use std::collections::BTreeSet;
use std::panic::AssertUnwindSafe;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use shared::exchange::{Lease, WorkResult};
use shared::outcome::{Fault, Outcome};
use tokio::sync::Notify;

use crate::model::{CompiledVariant, SharedTime};

/// One in this many of a calibration's first evaluations of an external model is repeated, because only a repetition shows whether the
/// answers agree.
const REPEATED: u64 = 20;
/// Evaluations with this number or a higher one are not repeated: a repetition holds its round up by the time of an evaluation, which
/// would double the time of a round in which every thread of the farm has one.
const REPEATED_BEFORE: u64 = 1000;

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

    /// Returns the number of completed evaluations.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// Returns the mean time of an evaluation `[s]`; `None` before the first.
    pub fn mean_s(&self) -> Option<f64> {
        let evaluations = self.evaluations();
        (evaluations > 0).then(|| self.simulated_s() / evaluations as f64)
    }
}

/// State that the threads share with the loop.
#[derive(Debug, Default)]
struct Bench {
    results: Mutex<Vec<WorkResult>>,
    /// Leases that are being evaluated.
    started: Mutex<BTreeSet<u64>>,
    /// Number of evaluations that are queued or running.
    outstanding: AtomicUsize,
    /// The loop is woken when this many evaluations are left, and when none is: waking it for every result would cost more
    /// than a short simulation.
    wake_at: AtomicUsize,
    wake: Notify,
    cancelled: AtomicBool,
}

/// A pool of threads with its finished results.
#[derive(Debug)]
pub struct Evaluator {
    pool: rayon::ThreadPool,
    bench: Arc<Bench>,
    clock: Arc<SimulationClock>,
}

impl Evaluator {
    /// Creates a pool of `threads` threads; an error if the operating system refuses them.
    pub fn new(threads: usize, clock: Arc<SimulationClock>) -> Result<Self, rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("simulate-{i}"))
            .build()?;
        Ok(Evaluator {
            pool,
            bench: Arc::default(),
            clock,
        })
    }

    /// Queues evaluations; a panic of the model becomes a fault.
    pub fn start(&self, batch: Vec<(Lease, Arc<CompiledVariant>)>) {
        let threads = self.pool.current_num_threads();
        let outstanding = self.bench.outstanding.fetch_add(batch.len(), Ordering::AcqRel) + batch.len();
        self.bench.wake_at.store(outstanding / 2, Ordering::Release);
        for (lease, variant) in batch {
            let (bench, clock) = (self.bench.clone(), self.clock.clone());
            self.pool.spawn_fifo(move || {
                // after the worker stops, evaluations that have not begun are given back
                if !bench.cancelled.load(Ordering::Acquire) {
                    let number = lease.lease;
                    lock(&bench.started).insert(number);
                    let is_shared = bench.outstanding.load(Ordering::Acquire) < threads;
                    let result = evaluate(lease, &variant, is_shared, &clock);
                    // The result is stored first, so that a lease is always in at least one list.
                    lock(&bench.results).push(result);
                    lock(&bench.started).remove(&number);
                }
                let left = bench.outstanding.fetch_sub(1, Ordering::AcqRel) - 1;
                if left == 0 || left == bench.wake_at.load(Ordering::Acquire) {
                    bench.wake.notify_one();
                }
            });
        }
    }

    /// Waits until half of the last batch is left, or nothing.
    pub async fn woken(&self) {
        self.bench.wake.notified().await;
    }

    /// Takes the results since the last call, in the order of completion.
    pub fn take(&self) -> Vec<WorkResult> {
        std::mem::take(&mut *lock(&self.bench.results))
    }

    /// Returns the numbers of the leases that are being evaluated.
    pub fn started(&self) -> Vec<u64> {
        lock(&self.bench.started).iter().copied().collect()
    }

    /// Drops the evaluations that have not begun, and waits for the rest.
    pub async fn cancel(&self) {
        self.bench.cancelled.store(true, Ordering::Release);
        self.bench.wake_at.store(0, Ordering::Release);
        while self.bench.outstanding.load(Ordering::Acquire) > 0 {
            self.woken().await;
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Evaluates a lease.
///
/// # Arguments
/// - `is_shared`: whether there are threads without an evaluation, with which this one shares its conditions.
fn evaluate(lease: Lease, variant: &CompiledVariant, is_shared: bool, clock: &SimulationClock) -> WorkResult {
    let began = Instant::now();
    let shared = SharedTime::default();
    let evaluated = AssertUnwindSafe(|| match is_shared {
        true => variant.evaluate_with_idle_threads(&lease.theta, &shared),
        false => variant.evaluate(&lease.theta),
    });
    let outcome = std::panic::catch_unwind(evaluated).unwrap_or_else(|_| {
        Outcome::Fault(Fault {
            message: "the model panicked".into(),
        })
    });
    // The number decides, so that the choice does not depend on the worker.
    let is_repeated = lease.evaluation < REPEATED_BEFORE && lease.evaluation.is_multiple_of(REPEATED);
    let repeat = AssertUnwindSafe(|| variant.repeat(&lease.theta, &outcome));
    let repeated = match is_repeated {
        true => std::panic::catch_unwind(repeat).unwrap_or_default(),
        false => None,
    };
    // While a thread waits for conditions that it shares, it may begin another evaluation: the conditions' own time counts.
    let elapsed = shared.total().unwrap_or_else(|| began.elapsed());
    let elapsed = u64::try_from(elapsed.as_nanos()).unwrap_or(u64::MAX);
    clock.simulated_ns.fetch_add(elapsed, Ordering::Relaxed);
    clock.evaluations.fetch_add(1, Ordering::Relaxed);
    let Lease {
        lease,
        calibration,
        evaluation,
        seal,
        ..
    } = lease;
    WorkResult {
        lease,
        calibration,
        evaluation,
        seal,
        outcome,
        repeated,
    }
}
