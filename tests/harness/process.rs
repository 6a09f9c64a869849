//! A program that is running: its log, signals, its end.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};

use crate::wait::until;

/// A signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// Ends at once, unseen.
    Kill,
    /// Asks to end.
    Terminate,
    /// The signal of ^C.
    Interrupt,
    /// Halts.
    Stop,
    /// Goes on.
    Continue,
    /// The signal that a queue may send before it ends a job, SIGUSR1.
    User,
}

/// A running program; killed when dropped.
#[derive(Debug)]
pub struct Process {
    child: Child,
    log: PathBuf,
}

impl Process {
    /// Starts a command; what it says on standard error is appended to the file `log`.
    ///
    /// # Panics
    /// The operating system refuses.
    pub fn start(mut command: Command, log: &Path) -> Process {
        let file = File::options()
            .create(true)
            .append(true)
            .open(log)
            .expect("the log can be written");
        let child = command.stderr(file).spawn().expect("the program starts");
        Process {
            child,
            log: log.to_owned(),
        }
    }

    /// Starts a worker.
    pub fn worker(url: &str, threads: usize, log: &Path) -> Process {
        let command = crate::programs::worker(["--coordinator", url, "--threads", &threads.to_string()]);
        Process::start(command, log)
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Sends a signal.
    ///
    /// # Panics
    /// There is no such process any more.
    #[track_caller]
    pub fn signal(&self, signal: Signal) {
        let name = match signal {
            Signal::Kill => "KILL",
            Signal::Terminate => "TERM",
            Signal::Interrupt => "INT",
            Signal::Stop => "STOP",
            Signal::Continue => "CONT",
            Signal::User => "USR1",
        };
        let line = format!("kill -{name} {}", self.child.id());
        let sent = Command::new("sh")
            .args(["-c", &line])
            .status()
            .expect("there is a shell");
        assert!(sent.success(), "{line}");
    }

    /// Memory that it holds `[kB]`; `None` where it has ended.
    pub fn resident_kb(&self) -> Option<u64> {
        self.memory_kb("VmRSS:")
    }

    /// The largest memory that it ever held `[kB]`; `None` where it has ended.
    pub fn peak_kb(&self) -> Option<u64> {
        self.memory_kb("VmHWM:")
    }

    fn memory_kb(&self, key: &str) -> Option<u64> {
        let path = format!("/proc/{}/status", self.child.id());
        let status = std::fs::read_to_string(path).ok()?;
        let value = status.lines().find_map(|line| line.strip_prefix(key))?;
        value.trim_end_matches("kB").trim().parse().ok()
    }

    /// Whether it has not ended.
    ///
    /// # Panics
    /// The operating system refuses to say.
    pub fn is_running(&mut self) -> bool {
        self.child.try_wait().expect("a child can be asked").is_none()
    }

    /// Kills it and waits for its end.
    ///
    /// # Panics
    /// The operating system refuses.
    pub fn kill(&mut self) {
        // Fails only where it has ended already, which is as good.
        let _ = self.child.kill();
        self.child.wait().expect("a child can be waited for");
    }

    /// Waits for its end.
    ///
    /// # Panics
    /// It does not end in time.
    #[track_caller]
    pub fn wait(&mut self) -> ExitStatus {
        until("the end of a process", || {
            self.child.try_wait().expect("a child can be asked")
        })
    }

    /// The log of it and of its predecessors with the same file: standard error.
    ///
    /// # Panics
    /// The log is gone.
    pub fn log(&self) -> String {
        String::from_utf8_lossy(&std::fs::read(&self.log).expect("the log can be read")).into_owned()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.kill();
    }
}
