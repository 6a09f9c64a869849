//! A program of the farm that is killed and halted, and then started or resumed.

use std::path::PathBuf;
use std::process::{Command, ExitStatus};
use std::time::{Duration, Instant};

use crate::process::{Process, Signal};

/// A program, which need not be running.
pub(super) struct Program {
    command: Box<dyn Fn() -> Command>,
    log: PathBuf,
    pub(super) process: Option<Process>,
    is_halted: bool,
    /// The time at which it is started or resumed.
    due: Option<Instant>,
}

impl Program {
    /// Starts a program.
    pub(super) fn start(log: PathBuf, command: impl Fn() -> Command + 'static) -> Program {
        let process = Some(Process::start(command(), &log));
        Program {
            command: Box::new(command),
            log,
            process,
            is_halted: false,
            due: None,
        }
    }

    /// Returns whether the program is running and not halted.
    pub(super) fn is_awake(&self) -> bool {
        self.process.is_some() && !self.is_halted
    }

    /// Takes the process out, and plans the start of another one.
    fn take(&mut self, down: Duration) -> Option<Process> {
        self.is_halted = false;
        self.due = Some(Instant::now() + down);
        self.process.take()
    }

    /// Kills the program for a time.
    pub(super) fn kill(&mut self, down: Duration) {
        // A process is killed when it is dropped.
        drop(self.take(down));
    }

    /// Halts the program for a time.
    pub(super) fn halt(&mut self, time: Duration) {
        if let Some(process) = self.process.as_mut().filter(|_| !self.is_halted)
            && process.is_running()
        {
            process.signal(Signal::Stop);
            self.is_halted = true;
            self.due = Some(Instant::now() + time);
        }
    }

    /// Starts or resumes the program if that is due; returns whether it was started.
    pub(super) fn recover(&mut self, now: Instant) -> bool {
        if self.due.take_if(|due| *due <= now).is_none() {
            return false;
        }
        if std::mem::take(&mut self.is_halted)
            && let Some(process) = &self.process
        {
            process.signal(Signal::Continue);
        }
        let is_dead = self.process.is_none();
        if is_dead {
            self.process = Some(Process::start((self.command)(), &self.log));
        }
        is_dead
    }

    /// Returns the exit status of a program that ended without being killed; it is started again after `down`.
    pub(super) fn ended(&mut self, down: Duration) -> Option<ExitStatus> {
        if self.process.as_mut()?.is_running() {
            return None;
        }
        self.take(down).map(|mut process| process.wait())
    }

    /// Returns the log since the first start.
    pub(super) fn log(&self) -> String {
        String::from_utf8_lossy(&std::fs::read(&self.log).expect("the log can be read")).into_owned()
    }
}
