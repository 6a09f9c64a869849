//! The compute threads, which take the steps of engines, so that the farm's thread never computes.
//!
//! The farm's thread knows which threads are idle and gives each one step at a time, short ones first. One thread takes short steps alone,
//! so that no small calibration waits for a large one.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, mpsc};

use crate::calibration::{Step, Stepped};

/// A function that takes a step: [`Step::run`].
pub(super) type TakeStep = Arc<dyn Fn(Step) -> Stepped + Send + Sync>;

/// Tells what a compute thread has done.
pub(super) type Tell = Box<dyn FnOnce(Computed) + Send>;

/// What a compute thread has done.
#[derive(Debug)]
pub(super) struct Computed {
    /// The index of the thread, which is idle now.
    pub(super) thread: usize,
    /// The step, or the one that ended in a panic.
    pub(super) result: Result<Stepped, FailedStep>,
}

/// A step that ended in a panic.
#[derive(Debug)]
pub(super) struct FailedStep {
    pub(super) calibration: i64,
    pub(super) number: u64,
    pub(super) reason: String,
}

/// The compute threads and the steps that wait for one.
pub(super) struct Compute {
    threads: Vec<Thread>,
    /// The steps that wait: short ones first, then in order of their numbers.
    waiting: BTreeMap<(bool, u64), Step>,
}

struct Thread {
    steps: mpsc::Sender<(Step, Tell)>,
    is_idle: bool,
}

impl Compute {
    /// Starts the threads: one for each core, two at least.
    ///
    /// # Errors
    /// The operating system refuses a thread.
    pub(super) fn start(take: &TakeStep) -> std::io::Result<Compute> {
        let cores = std::thread::available_parallelism().map_or(2, usize::from);
        let threads = (0..cores.max(2)).map(|thread| {
            let (steps, receiver) = mpsc::channel();
            let take = take.clone();
            let name = format!("compute-{thread}");
            std::thread::Builder::new()
                .name(name)
                .spawn(move || work(thread, &receiver, &take))?;
            Ok(Thread { steps, is_idle: true })
        });
        Ok(Compute {
            threads: threads.collect::<std::io::Result<_>>()?,
            waiting: BTreeMap::new(),
        })
    }

    /// Adds steps that are due.
    pub(super) fn add(&mut self, steps: Vec<Step>) {
        let key = |step: &Step| (step.is_long(), step.number());
        self.waiting
            .extend(steps.into_iter().map(|step| (key(&step), step)));
    }

    /// Drops the waiting steps that nobody needs any more. `needs` says of a calibration whether it waits for the step of a number.
    pub(super) fn drop_needless(&mut self, needs: impl Fn(i64, u64) -> bool) {
        self.waiting
            .retain(|_, step| needs(step.calibration(), step.number()));
    }

    /// Notes that a thread is idle.
    pub(super) fn rests(&mut self, thread: usize) {
        self.threads[thread].is_idle = true;
    }

    /// Gives the idle threads what waits. `tell` makes the function that tells the farm of a step.
    pub(super) fn hand_out(&mut self, tell: impl Fn() -> Option<Tell>) {
        // The first thread takes short steps alone.
        for (index, thread) in self.threads.iter_mut().enumerate() {
            let next = self.waiting.first_key_value().map(|(&key, _)| key);
            let Some(key @ (is_long, _)) = next else { return };
            if !thread.is_idle || (is_long && index == 0) {
                continue;
            }
            let (Some(tell), Some(step)) = (tell(), self.waiting.remove(&key)) else {
                return;
            };
            // A thread ends with this value alone.
            thread.is_idle = thread.steps.send((step, tell)).is_err();
        }
    }
}

/// How much higher the niceness of the compute threads is than that of the others.
#[cfg(target_os = "linux")]
const NICENESS: i32 = 5;

/// Lowers the priority of this thread, so that threads that answer requests run first where cores are few: an answer would wait for the end
/// of a step's turn. Only Linux gives a thread its own niceness.
fn lower_priority() {
    #[cfg(target_os = "linux")]
    if let Err(error) = rustix::process::nice(NICENESS) {
        tracing::debug!(%error, "a compute thread keeps its priority");
    }
}

/// Takes steps until the farm's thread has ended.
fn work(thread: usize, steps: &mpsc::Receiver<(Step, Tell)>, take: &TakeStep) {
    lower_priority();
    while let Ok((step, tell)) = steps.recv() {
        let (calibration, number) = (step.calibration(), step.number());
        let result = catch_unwind(AssertUnwindSafe(|| take(step))).map_err(|panic| {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
            FailedStep {
                calibration,
                number,
                reason: text.unwrap_or("a panic without a message").to_owned(),
            }
        });
        tell(Computed { thread, result });
    }
}
