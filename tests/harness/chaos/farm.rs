//! The farm: one coordinator on a disk, workers behind a proxy, backups.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::backups::Backups;
use super::disk::{Disk, without_signal};
use super::event::{Event, Fault, LEASE_MS, WORKERS};
use super::network::{Toward, Weather};
use super::program::Program;
use super::proxy::Proxy;
use super::tally::Tally;
use crate::http::Client;
use crate::programs;
use crate::service::free_address;

/// A backup is made before every so many events.
const BACKUP_EVERY: u64 = 6;
/// What ended by itself starts again after.
const AGAIN: Duration = Duration::from_millis(200);
/// Every part of a message that is late takes so long.
const LATE: Duration = Duration::from_millis(40);

/// The farm.
pub(super) struct Farm {
    pub(super) client: Client,
    coordinator: Program,
    workers: Vec<Program>,
    proxy: Proxy,
    disk: Disk,
    backups: Backups,
    /// The network is well again, and the disk empty.
    network_due: Option<Instant>,
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
        let proxy = Proxy::start(&address);
        let store = format!("sqlite://{}", disk.store().display());
        let lease = LEASE_MS.to_string();
        let words = [
            "serve",
            "--listen",
            &address,
            "--store",
            &store,
            "--lease-ms",
            &lease,
        ];
        let words = words.map(str::to_owned);
        let is_mounted = disk.is_mounted;
        let serve = move || match (programs::coordinator(&words), is_mounted) {
            (command, true) => command,
            (command, false) => without_signal(&command),
        };
        let coordinator = Program::start(folder.path().join("coordinator.log"), serve);
        let workers = (0..WORKERS).map(|worker| {
            let url = proxy.url();
            let work = move || programs::worker(["--coordinator", &url, "--threads", "1"]);
            Program::start(folder.path().join(format!("worker-{worker}.log")), work)
        });
        Farm {
            client: Client(address),
            coordinator,
            workers: workers.collect(),
            proxy,
            disk,
            backups: Backups::new(folder.path()),
            network_due: None,
            disk_due: None,
            is_excused: false,
            folder,
        }
    }

    /// Whether the disk is a file system of its own.
    pub(super) fn has_disk(&self) -> bool {
        self.disk.is_mounted
    }

    /// Whether a failure of the service is the disk's.
    pub(super) fn is_excused(&self) -> bool {
        self.is_excused
    }

    /// Whether the coordinator can be asked.
    pub(super) fn answers(&self) -> bool {
        self.coordinator.is_awake()
    }

    /// Lets an event happen; whether it put a backup back.
    pub(super) fn suffer(&mut self, event: &Event, tally: &mut Tally) -> bool {
        if event.number.is_multiple_of(BACKUP_EVERY) {
            self.backups.make(&self.disk.store(), event.number);
        }
        let due = Some(Instant::now() + event.lasting);
        let worker = &mut self.workers[event.worker];
        match event.fault {
            Fault::CoordinatorKilled => self.coordinator.kill(event.lasting),
            Fault::WorkerKilled => worker.kill(event.lasting),
            Fault::AllKilled => {
                self.coordinator.kill(event.lasting);
                self.workers
                    .iter_mut()
                    .for_each(|worker| worker.kill(event.lasting));
            }
            Fault::CoordinatorStopped => {
                let stopped = self.coordinator.stop(event.lasting);
                tally.note_stop("coordinator", stopped, self.is_excused);
            }
            Fault::WorkerStopped => {
                let stopped = worker.stop(event.lasting);
                tally.note_stop("worker", stopped, false);
            }
            Fault::CoordinatorHalted => self.coordinator.halt(event.lasting),
            Fault::WorkerHalted => worker.halt(event.lasting),
            Fault::ConnectionsCut => self.proxy.network().cut(),
            Fault::RequestCut => self.proxy.network().cut_after(Toward::Coordinator, event.bytes),
            Fault::AnswerCut => self.proxy.network().cut_after(Toward::Workers, event.bytes),
            Fault::ConnectionsRefused => self.change(Weather::Refusing, due),
            Fault::NetworkLate => self.change(Weather::Late(LATE), due),
            Fault::NetworkSilent => self.change(Weather::Silent, due),
            Fault::DiskFull => {
                let writer = self.coordinator.process().map(|process| process.id());
                self.disk.fill(event.bytes, writer);
                self.is_excused = true;
                self.disk_due = due;
            }
            Fault::BackupPutBack => return self.put_back(event),
        }
        false
    }

    fn change(&mut self, weather: Weather, due: Option<Instant>) {
        self.proxy.network().set(weather);
        self.network_due = due;
    }

    fn put_back(&mut self, event: &Event) -> bool {
        let Some(copy) = self.backups.before_newest(event.age).map(Path::to_owned) else {
            return false;
        };
        self.coordinator.kill(event.lasting);
        self.empty_disk();
        self.disk.put_back(&copy);
        true
    }

    fn empty_disk(&mut self) {
        let writer = self.coordinator.process().map(|process| process.id());
        self.disk.empty(writer);
        self.disk_due = None;
    }

    /// Ends what is over and starts what is due.
    ///
    /// # Errors
    /// A program has ended by itself.
    pub(super) fn tend(&mut self, tally: &mut Tally) -> Result<(), String> {
        let now = Instant::now();
        if self.network_due.is_some_and(|due| due <= now) {
            self.change(Weather::Passing, None);
        }
        if self.disk_due.is_some_and(|due| due <= now) {
            self.empty_disk();
        }
        for worker in &mut self.workers {
            worker.come_back(now);
            if let Some(status) = worker.ended(AGAIN) {
                return Err(format!("a worker ended by itself, {status}:\n{}", worker.log()));
            }
            tally.note_memory("worker", worker.process());
        }
        if self.coordinator.come_back(now) {
            self.is_excused = self.disk.is_full;
        }
        if let Some(status) = self.coordinator.ended(AGAIN) {
            if !self.is_excused || status.code() != Some(1) {
                let log = self.coordinator.log();
                return Err(format!("the coordinator ended by itself, {status}:\n{log}"));
            }
            tally.ends_on_full_disk += 1;
        }
        tally.note_memory("coordinator", self.coordinator.process());
        Ok(())
    }

    /// Heals network and disk; who is dead or halted comes back at its time.
    pub(super) fn heal(&mut self) {
        self.change(Weather::Passing, None);
        self.empty_disk();
    }

    /// No log tells of a panic.
    ///
    /// # Errors
    /// The line that does.
    pub(super) fn check_logs(&self) -> Result<(), String> {
        for program in [&self.coordinator].into_iter().chain(&self.workers) {
            let log = program.log();
            if let Some(line) = log.lines().find(|line| line.contains("panicked")) {
                return Err(line.to_owned());
            }
        }
        Ok(())
    }

    /// Ends everything and keeps the logs and the store in a folder.
    pub(super) fn keep(mut self) -> PathBuf {
        self.coordinator.kill(Duration::ZERO);
        let store = self.disk.store();
        for end in ["", "-wal"] {
            let name = format!("grouser.db{end}");
            // Where the coordinator has closed the store, there is no log of it.
            let _ = std::fs::copy(store.with_file_name(&name), self.folder.path().join(&name));
        }
        self.folder.keep()
    }
}
