//! Events, each of which is a function of a seed and its number.

use std::fmt::{Display, Formatter, Result};
use std::time::Duration;

use statistics::rng::Stream;

/// The time of a lease `[ms]`.
pub(super) const LEASE_MS: usize = 1_000;
/// The number of workers of the farm.
pub(super) const WORKERS: usize = 2;

/// A fault. A killed program is started again later, and a halted one resumed.
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

/// Every fault with its name and its relative frequency.
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

/// One event, with the numbers for every kind of fault.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    pub(super) number: u64,
    /// The time since the event before.
    pub(super) wait: Duration,
    pub(super) fault: Fault,
    /// The duration of the fault; a killed program starts again after it.
    pub(super) lasting: Duration,
    /// The number of the worker for faults of one worker.
    pub(super) worker: usize,
    /// The number of bytes that a cut connection still passes, or that a full disk still takes.
    pub(super) bytes: usize,
    /// The backup that is restored, counted from the newest.
    pub(super) age: usize,
}

impl Event {
    /// Draws the event of a number.
    pub(super) fn draw(seed: u64, number: u64) -> Event {
        let mut stream = Stream::new(seed, 0, number, 0);
        let weighted = FAULTS.iter().flat_map(|(fault, _, weight)| vec![*fault; *weight]);
        let weighted: Vec<Fault> = weighted.collect();
        let fault = weighted[stream.below(weighted.len())];
        // One fault in three outlasts the leases.
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

    /// Returns the name of its fault.
    pub(super) fn name(&self) -> &'static str {
        let entry = FAULTS.iter().find(|(fault, ..)| *fault == self.fault);
        entry.expect("every fault has a name").1
    }
}

impl Display for Event {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (number, seconds, name) = (self.number, self.lasting.as_secs_f64(), self.name());
        write!(
            f,
            "event {number}: {name} ({seconds:.1} s, worker {}, ",
            self.worker
        )?;
        write!(f, "{} bytes, {} before the newest backup)", self.bytes, self.age)
    }
}
