//! The farm: one coordinator on a disk, workers behind a proxy, and backups.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::disk::Disk;
use super::event::{Event, Fault, LEASE_MS, WORKERS};
use super::program::Program;
use super::tally::Tally;
use crate::http::Client;
use crate::programs;
use crate::proxy::{Proxy, Toward};
use crate::service::free_address;

/// The number of events between two backups.
const BACKUP_EVERY: u64 = 6;
/// The number of backups that are kept.
const KEPT: usize = 3;
/// The time after which a program that ended without being killed is started again.
const RESTART: Duration = Duration::from_millis(200);
/// The largest memory of a program `[MB]`.
const MAX_MB: f64 = 300.0;

/// The farm.
pub(super) struct Farm {
    pub(super) client: Client,
    /// The coordinator, then the workers, each with its kind.
    programs: Vec<(&'static str, Program)>,
    proxy: Proxy,
    disk: Disk,
    /// The last backups, the newest first.
    backups: VecDeque<PathBuf>,
    /// The time at which the disk is emptied.
    disk_due: Option<Instant>,
    /// Whether the disk has been full since the coordinator started, so that the coordinator may fail or end.
    may_fail: bool,
    // The last field, so that it is dropped after the programs that write to it.
    folder: TempDir,
}

impl Farm {
    /// Starts a farm with an empty store.
    pub(super) fn start() -> Farm {
        let folder = tempfile::tempdir().expect("a folder");
        let disk = Disk::new(folder.path().join("disk"));
        let address = free_address();
        let (proxy, url) = Proxy::start(&address);
        let store = format!("sqlite://{}", disk.store().display());
        let (at, lease) = (address.clone(), LEASE_MS.to_string());
        let words = "coordinator serve --listen {} --store {} --lease-ms {}";
        let serve = move || programs::line(words, &[&at, &store, &lease]);
        let coordinator = Program::start(folder.path().join("coordinator.log"), serve);
        let workers = (0..WORKERS).map(|worker| {
            let url = url.clone();
            let work = move || programs::worker(["--coordinator", &url, "--threads", "1"]);
            let log = folder.path().join(format!("worker-{worker}.log"));
            ("worker", Program::start(log, work))
        });
        Farm {
            client: Client(address),
            programs: [("coordinator", coordinator)]
                .into_iter()
                .chain(workers)
                .collect(),
            proxy,
            disk,
            backups: VecDeque::new(),
            disk_due: None,
            may_fail: false,
            folder,
        }
    }

    fn coordinator(&mut self) -> &mut Program {
        &mut self.programs[0].1
    }

    /// Returns whether a full disk excuses a failure of the service.
    pub(super) fn may_fail(&self) -> bool {
        self.may_fail
    }

    /// Returns whether the coordinator is running and not halted.
    pub(super) fn answers(&self) -> bool {
        self.programs[0].1.is_awake()
    }

    /// Applies an event; returns whether it restored a backup.
    pub(super) fn apply(&mut self, event: &Event) -> bool {
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
                self.may_fail = true;
                self.disk_due = Some(Instant::now() + lasting);
            }
            Fault::BackupPutBack => {
                let oldest = self.backups.len().saturating_sub(1);
                let Some(copy) = self.backups.get(event.age.min(oldest)).cloned() else {
                    return false;
                };
                self.coordinator().kill(lasting);
                self.disk.empty();
                self.disk.restore(&copy);
                return true;
            }
        }
        false
    }

    /// Copies the store, which may be in use. A full disk may prevent the copy.
    fn make_backup(&mut self, number: u64) {
        let copy = self.folder.path().join(format!("backup-{number}.db"));
        let made = programs::call(
            "coordinator backup {} --store sqlite://{}",
            &[&copy, &self.disk.store()],
        );
        if made.code == Some(0) {
            self.backups.push_front(copy);
        }
        for old in self.backups.drain(self.backups.len().min(KEPT)..) {
            std::fs::remove_file(old).expect("a backup is there");
        }
    }

    /// Ends faults whose time is over, and starts programs that are due. An error means that a program has ended without being killed, or
    /// holds too much memory.
    pub(super) fn update(&mut self, tally: &mut Tally) -> Result<(), String> {
        let now = Instant::now();
        if self.disk_due.take_if(|due| *due <= now).is_some() {
            self.disk.empty();
        }
        for (name, program) in &mut self.programs {
            let is_coordinator = *name == "coordinator";
            if program.recover(now) && is_coordinator {
                self.may_fail = self.disk.is_full;
            }
            if let Some(status) = program.ended(RESTART) {
                if !is_coordinator || !self.may_fail || status.code() != Some(1) {
                    return Err(format!("a {name} ended, {status}:\n{}", program.log()));
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

    /// Empties the disk. Killed and halted programs recover when they are due.
    pub(super) fn empty_disk(&mut self) {
        self.disk.empty();
    }

    /// Checks that no log has a panic; the error is the line of the first one.
    pub(super) fn check_logs(&self) -> Result<(), String> {
        for (_, program) in &self.programs {
            if let Some(line) = program.log().lines().find(|line| line.contains("panicked")) {
                return Err(line.to_owned());
            }
        }
        Ok(())
    }

    /// Kills the coordinator and keeps the logs and the store in a folder.
    pub(super) fn keep(mut self) -> PathBuf {
        self.coordinator().kill(Duration::ZERO);
        let store = self.disk.store();
        for name in ["grouser.db", "grouser.db-wal"] {
            // A closed store has no write-ahead log.
            let _ = std::fs::copy(store.with_file_name(name), self.folder.path().join(name));
        }
        self.folder.keep()
    }
}
