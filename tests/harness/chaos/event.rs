//! Events: each follows from a seed and its number alone.

use std::fmt::{Display, Formatter, Result};
use std::time::Duration;

use statistics::rng::Stream;

/// The time of a lease `[ms]`.
pub(super) const LEASE_MS: usize = 1_000;
/// The number of workers of the farm.
pub(super) const WORKERS: usize = 2;

/// A fault. A killed program starts again after a while; a halted one goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    CoordinatorKilled,
    WorkerKilled,
    AllKilled,
    CoordinatorHalted,
    WorkerHalted,
    ConnectionsCut,
    RequestCut,
    AnswerCut,
    DiskFull,
    BackupPutBack,
}

/// Every fault, its words, and its frequency relative to the others.
pub(super) const FAULTS: [(Fault, &str, usize); 10] = [
    (Fault::CoordinatorKilled, "coordinator killed", 4),
    (Fault::WorkerKilled, "worker killed", 4),
    (Fault::AllKilled, "all killed", 2),
    (Fault::CoordinatorHalted, "coordinator halted", 3),
    (Fault::WorkerHalted, "worker halted", 3),
    (Fault::ConnectionsCut, "connections cut", 2),
    (Fault::RequestCut, "cut within a request", 3),
    (Fault::AnswerCut, "cut within an answer", 3),
    (Fault::DiskFull, "disk full", 2),
    (Fault::BackupPutBack, "backup put back", 1),
];

/// One event. A fault uses the numbers that it needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    pub(super) number: u64,
    /// The time since the event before.
    pub(super) wait: Duration,
    pub(super) fault: Fault,
    /// The duration of the fault; a dead program starts again after it.
    pub(super) lasting: Duration,
    /// The worker that is hit.
    pub(super) worker: usize,
    /// Bytes that still pass, or that the disk still takes.
    pub(super) bytes: usize,
    /// The backup that is put back, counted from the newest.
    pub(super) age: usize,
}

impl Event {
    /// The event of a number.
    pub(super) fn draw(seed: u64, number: u64) -> Event {
        let mut stream = Stream::new(seed, 0, number, 0);
        let by_weight = FAULTS.iter().flat_map(|(fault, _, weight)| vec![*fault; *weight]);
        let by_weight: Vec<Fault> = by_weight.collect();
        let fault = by_weight[stream.below(by_weight.len())];
        // A third outlasts the leases.
        let lasting = match stream.below(3) {
            0 => LEASE_MS + stream.below(2_000),
            _ => stream.below(400),
        };
        Event {
            number,
            wait: Duration::from_millis(stream.below(600) as u64),
            fault,
            lasting: Duration::from_millis(lasting as u64),
            worker: stream.below(WORKERS),
            bytes: stream.below(30_000),
            age: stream.below(3),
        }
    }

    /// The words of its fault.
    pub(super) fn words(&self) -> &'static str {
        let words = FAULTS.iter().find(|(fault, ..)| *fault == self.fault);
        words.expect("every fault has words").1
    }
}

impl Display for Event {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (number, seconds) = (self.number, self.lasting.as_secs_f64());
        write!(
            f,
            "event {number}: {} ({seconds:.1} s, worker {}, ",
            self.words(),
            self.worker
        )?;
        write!(f, "{} bytes, {} before the newest backup)", self.bytes, self.age)
    }
}
