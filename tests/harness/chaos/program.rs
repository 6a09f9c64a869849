//! A program of the farm that is killed, stopped and halted, and comes back.

use std::path::PathBuf;
use std::process::{Command, ExitStatus};
use std::time::{Duration, Instant};

use crate::process::{Process, Signal};

/// A program, whether it runs or not.
pub(super) struct Program {
    command: Box<dyn Fn() -> Command>,
    log: PathBuf,
    process: Option<Process>,
    is_halted: bool,
    /// When it starts again, or goes on.
    due: Option<Instant>,
}

impl Program {
    /// A program that is started now.
    pub(super) fn start(log: PathBuf, command: impl Fn() -> Command + 'static) -> Program {
        let process = Process::start(command(), &log);
        Program {
            command: Box::new(command),
            log,
            process: Some(process),
            is_halted: false,
            due: None,
        }
    }

    /// The process, unless it is dead.
    pub(super) fn process(&self) -> Option<&Process> {
        self.process.as_ref()
    }

    /// Whether it runs and is not halted.
    pub(super) fn is_awake(&self) -> bool {
        self.process.is_some() && !self.is_halted
    }

    /// Kills it; it starts again after a while.
    pub(super) fn kill(&mut self, down: Duration) {
        if let Some(mut process) = self.process.take() {
            process.kill();
        }
        self.is_halted = false;
        self.due = Some(Instant::now() + down);
    }

    /// Asks it to stop; it starts again after a while. How long it took, and how it ended, unless it is dead.
    pub(super) fn stop(&mut self, down: Duration) -> Option<(Duration, ExitStatus)> {
        self.go_on();
        self.due = Some(Instant::now() + down);
        let mut process = self.process.take()?;
        let began = Instant::now();
        if process.is_running() {
            process.signal(Signal::Terminate);
        }
        let status = process.wait();
        Some((began.elapsed(), status))
    }

    /// Halts it for a while.
    pub(super) fn halt(&mut self, time: Duration) {
        if let Some(process) = self.process.as_mut().filter(|_| !self.is_halted)
            && process.is_running()
        {
            process.signal(Signal::Stop);
            self.is_halted = true;
            self.due = Some(Instant::now() + time);
        }
    }

    fn go_on(&mut self) {
        if std::mem::take(&mut self.is_halted)
            && let Some(process) = &self.process
        {
            process.signal(Signal::Continue);
            self.due = None;
        }
    }

    /// Starts it again or lets it go on where that is due; whether it was started.
    pub(super) fn come_back(&mut self, now: Instant) -> bool {
        if self.due.is_none_or(|due| due > now) {
            return false;
        }
        self.due = None;
        self.go_on();
        let is_dead = self.process.is_none();
        if is_dead {
            self.process = Some(Process::start((self.command)(), &self.log));
        }
        is_dead
    }

    /// How it ended, where it did by itself; it starts again after a while.
    pub(super) fn ended(&mut self, down: Duration) -> Option<ExitStatus> {
        let mut process = self.process.take_if(|process| !process.is_running())?;
        self.is_halted = false;
        self.due = Some(Instant::now() + down);
        Some(process.wait())
    }

    /// What it has said, over all its starts.
    pub(super) fn log(&self) -> String {
        String::from_utf8_lossy(&std::fs::read(&self.log).expect("the log can be read")).into_owned()
    }
}
