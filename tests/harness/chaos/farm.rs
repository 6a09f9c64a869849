//! The farm: one coordinator on a disk, workers behind a proxy, backups.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::disk::Disk;
use super::event::{Event, Fault, LEASE_MS, WORKERS};
use super::program::Program;
use super::proxy::{Proxy, Toward};
use super::tally::Tally;
use crate::http::Client;
use crate::programs;
use crate::service::free_address;

/// The number of events between two backups.
const BACKUP_EVERY: u64 = 6;
/// The number of backups that are kept.
const KEPT: usize = 3;
/// The time after which a program that ended by itself starts again.
const AGAIN: Duration = Duration::from_millis(200);
/// The largest memory of a program `[MB]`.
const MAX_MB: f64 = 300.0;

/// The farm.
pub(super) struct Farm {
    pub(super) client: Client,
    /// The coordinator, then the workers, with the names of their kinds.
    programs: Vec<(&'static str, Program)>,
    proxy: Proxy,
    disk: Disk,
    /// The last backups, the newest first.
    backups: VecDeque<PathBuf>,
    /// The time at which the disk is emptied.
    disk_due: Option<Instant>,
    /// Whether the disk has been full since the coordinator started: it may end, and say that it cannot.
    is_excused: bool,
    // Last, so that it outlives what writes to it.
    folder: TempDir,
}

impl Farm {
    /// A farm with an empty store.
    pub(super) fn start() -> Farm {
        let folder = tempfile::tempdir().expect("a folder");
        let disk = Disk::at(folder.path().join("disk"));
        let address = free_address();
        let (proxy, url) = Proxy::start(&address);
        let store = format!("sqlite://{}", disk.store().display());
        let (at, lease) = (address.clone(), LEASE_MS.to_string());
        let serve = move || {
            let words = ["serve", "--listen", &at, "--store", &store, "--lease-ms", &lease];
            programs::coordinator(words)
        };
        let coordinator = Program::start(folder.path().join("coordinator.log"), serve);
        let workers = (0..WORKERS).map(|worker| {
            let url = url.clone();
            let work = move || programs::worker(["--coordinator", &url, "--threads", "1"]);
            let log = folder.path().join(format!("worker-{worker}.log"));
            ("worker", Program::start(log, work))
        });
        Farm {
            client: Client(address),
            programs: std::iter::once(("coordinator", coordinator))
                .chain(workers)
                .collect(),
            proxy,
            disk,
            backups: VecDeque::new(),
            disk_due: None,
            is_excused: false,
            folder,
        }
    }

    fn coordinator(&mut self) -> &mut Program {
        &mut self.programs[0].1
    }

    /// Whether a failure of the service is the disk's.
    pub(super) fn is_excused(&self) -> bool {
        self.is_excused
    }

    /// Whether the coordinator can be asked.
    pub(super) fn answers(&self) -> bool {
        self.programs[0].1.is_awake()
    }

    /// Lets an event happen; whether it put a backup back.
    pub(super) fn suffer(&mut self, event: &Event) -> bool {
        if event.number.is_multiple_of(BACKUP_EVERY) {
            self.make_backup(event.number);
        }
        let (worker, lasting) = (1 + event.worker, event.lasting);
        match event.fault {
            Fault::CoordinatorKilled => self.coordinator().kill(lasting),
            Fault::WorkerKilled => self.programs[worker].1.kill(lasting),
            Fault::AllKilled => self
                .programs
                .iter_mut()
                .for_each(|(_, program)| program.kill(lasting)),
            Fault::CoordinatorHalted => self.coordinator().halt(lasting),
            Fault::WorkerHalted => self.programs[worker].1.halt(lasting),
            Fault::ConnectionsCut => self.proxy.network().cut(),
            Fault::RequestCut => self.proxy.network().cut_after = Some((Toward::Coordinator, event.bytes)),
            Fault::AnswerCut => self.proxy.network().cut_after = Some((Toward::Workers, event.bytes)),
            Fault::DiskFull => {
                self.disk.fill(event.bytes);
                self.is_excused = true;
                self.disk_due = Some(Instant::now() + lasting);
            }
            Fault::BackupPutBack => {
                let oldest = self.backups.len().saturating_sub(1);
                let Some(copy) = self.backups.get(event.age.min(oldest)).cloned() else {
                    return false;
                };
                self.coordinator().kill(lasting);
                self.disk.empty();
                self.disk.put_back(&copy);
                return true;
            }
        }
        false
    }

    /// Copies the store while it may be in use, unless its disk does not let the program.
    fn make_backup(&mut self, number: u64) {
        let copy = self.folder.path().join(format!("backup-{number}.db"));
        let store = format!("sqlite://{}", self.disk.store().display());
        let words = ["backup", &copy.display().to_string(), "--store", &store];
        if programs::run(programs::coordinator(words)).code == Some(0) {
            self.backups.push_front(copy);
        }
        for old in self.backups.drain(self.backups.len().min(KEPT)..) {
            std::fs::remove_file(old).expect("a backup is there");
        }
    }

    /// Ends what is over and starts what is due.
    ///
    /// # Errors
    /// A program has ended by itself, or holds too much memory.
    pub(super) fn tend(&mut self, tally: &mut Tally) -> Result<(), String> {
        let now = Instant::now();
        if self.disk_due.take_if(|due| *due <= now).is_some() {
            self.disk.empty();
        }
        for (name, program) in &mut self.programs {
            let is_coordinator = *name == "coordinator";
            if program.come_back(now) && is_coordinator {
                self.is_excused = self.disk.is_full;
            }
            if let Some(status) = program.ended(AGAIN) {
                if !is_coordinator || !self.is_excused || status.code() != Some(1) {
                    return Err(format!("a {name} ended by itself, {status}:\n{}", program.log()));
                }
                tally.ends_on_full_disk += 1;
            }
            let memory_kb = program.process.as_ref().and_then(|process| process.resident_kb());
            let memory_mb = memory_kb.unwrap_or_default() as f64 / 1e3;
            tally.note(&format!("MB in a {name} at most"), memory_mb);
            if memory_mb > MAX_MB {
                return Err(format!("a {name} holds {memory_mb} MB"));
            }
        }
        Ok(())
    }

    /// Empties the disk; dead or halted programs come back at their time.
    pub(super) fn heal(&mut self) {
        self.disk.empty();
    }

    /// No log tells of a panic.
    ///
    /// # Errors
    /// The line that does.
    pub(super) fn check_logs(&self) -> Result<(), String> {
        let logs = self.programs.iter().map(|(_, program)| program.log());
        let panics = logs.flat_map(|log| log.lines().map(str::to_owned).collect::<Vec<_>>());
        let mut panics = panics.filter(|line| line.contains("panicked"));
        panics.next().map_or(Ok(()), Err)
    }

    /// Ends everything and keeps the logs and the store in a folder.
    pub(super) fn keep(mut self) -> PathBuf {
        self.coordinator().kill(Duration::ZERO);
        let store = self.disk.store();
        for name in ["grouser.db", "grouser.db-wal"] {
            // There is no log of a store that the coordinator has closed.
            let _ = std::fs::copy(store.with_file_name(name), self.folder.path().join(name));
        }
        self.folder.keep()
    }
}
