//! What happens to the farm: events, each of which follows from a seed and its number alone.

use std::fmt::{Display, Formatter, Result};
use std::time::Duration;

use statistics::rng::Stream;

/// A lease lasts so long `[ms]`.
pub(super) const LEASE_MS: usize = 1_000;
/// Workers of the farm.
pub(super) const WORKERS: usize = 2;

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// The coordinator gets SIGKILL, and starts again after a while.
    CoordinatorKilled,
    /// A worker gets SIGKILL, and another starts after a while.
    WorkerKilled,
    /// Coordinator and workers get SIGKILL at once.
    AllKilled,
    /// The coordinator gets SIGTERM, and starts again.
    CoordinatorStopped,
    /// A worker gets SIGTERM, and another starts.
    WorkerStopped,
    /// The coordinator stands still (SIGSTOP, SIGCONT), for longer than a lease or less.
    CoordinatorHalted,
    /// A worker stands still.
    WorkerHalted,
    /// Every connection between workers and coordinator is closed.
    ConnectionsCut,
    /// The same as soon as so many more bytes have passed to the coordinator.
    RequestCut,
    /// The same as soon as so many more bytes have passed to the workers.
    AnswerCut,
    /// Connections are closed as soon as they are opened.
    ConnectionsRefused,
    /// Whatever passes is late.
    NetworkLate,
    /// Nothing passes, and nobody is told; in the end the connections are closed.
    NetworkSilent,
    /// The disk of the store takes hardly more.
    DiskFull,
    /// The coordinator starts with an older copy of its store.
    BackupPutBack,
}

/// Every fault, its words, and how often it comes, relative to the others.
pub(super) const FAULTS: [(Fault, &str, usize); 15] = [
    (Fault::CoordinatorKilled, "coordinator killed", 4),
    (Fault::WorkerKilled, "worker killed", 4),
    (Fault::AllKilled, "all killed", 2),
    (Fault::CoordinatorStopped, "coordinator asked to stop", 2),
    (Fault::WorkerStopped, "worker asked to stop", 2),
    (Fault::CoordinatorHalted, "coordinator halted", 2),
    (Fault::WorkerHalted, "worker halted", 3),
    (Fault::ConnectionsCut, "connections cut", 2),
    (Fault::RequestCut, "cut within a request", 3),
    (Fault::AnswerCut, "cut within an answer", 3),
    (Fault::ConnectionsRefused, "connections refused", 1),
    (Fault::NetworkLate, "network late", 2),
    (Fault::NetworkSilent, "network silent", 2),
    (Fault::DiskFull, "disk full", 2),
    (Fault::BackupPutBack, "backup put back", 1),
];

/// One event.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    pub(super) number: u64,
    /// Time since the event before.
    pub(super) wait: Duration,
    pub(super) fault: Fault,
    /// How long it lasts, for what is dead until it starts again.
    pub(super) lasting: Duration,
    /// The worker that it hits, if it hits one.
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
        let mut at = stream.below(FAULTS.iter().map(|(_, _, weight)| weight).sum());
        let fault = FAULTS.iter().find(|(_, _, weight)| {
            let is_it = at < *weight;
            at = at.saturating_sub(*weight);
            is_it
        });
        let (fault, ..) = *fault.expect("a number below the sum of the weights");
        // A third outlasts the leases.
        let lasting = if stream.below(3) == 0 {
            LEASE_MS + stream.below(2_000)
        } else {
            stream.below(400)
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
}

impl Display for Event {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let words = FAULTS.iter().find(|(fault, ..)| *fault == self.fault);
        let (_, words, _) = words.expect("every fault has words");
        let seconds = self.lasting.as_secs_f64();
        write!(f, "event {}: {words}", self.number)?;
        match self.fault {
            Fault::ConnectionsCut => Ok(()),
            Fault::WorkerKilled | Fault::WorkerStopped | Fault::WorkerHalted => {
                write!(f, ": worker {}, {seconds:.1} s", self.worker)
            }
            Fault::RequestCut | Fault::AnswerCut => write!(f, " after {} bytes", self.bytes),
            Fault::DiskFull => write!(f, " but for {} bytes, {seconds:.1} s", self.bytes),
            Fault::BackupPutBack => write!(f, ": {} before the newest", self.age),
            _ => write!(f, ", {seconds:.1} s"),
        }
    }
}
