//! A running program: its log, its signals and its end.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};

use crate::wait::until;

/// A signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// SIGKILL, which the process cannot handle.
    Kill,
    /// SIGTERM.
    Terminate,
    /// SIGINT, which a terminal sends at ^C.
    Interrupt,
    /// SIGSTOP, which halts the process.
    Stop,
    /// SIGCONT, which resumes a halted process.
    Continue,
    /// SIGUSR1, which a queue may send before it ends a job.
    User,
}

/// A running program; killed when dropped.
#[derive(Debug)]
pub struct Process {
    child: Child,
    log: PathBuf,
}

impl Process {
    /// Starts a command; its standard error is appended to the file `log`.
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

    /// Returns the number of the process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Sends a signal.
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
        let sent = Command::new("sh").args(["-c", &line]).status();
        assert!(sent.expect("there is a shell").success(), "{line}");
    }

    /// Returns the resident memory of the process `[kB]`; `None` after its end.
    pub fn resident_kb(&self) -> Option<u64> {
        self.memory_kb("VmRSS:")
    }

    /// Returns the largest resident memory so far `[kB]`; `None` after the end of the process.
    pub fn peak_kb(&self) -> Option<u64> {
        self.memory_kb("VmHWM:")
    }

    fn memory_kb(&self, key: &str) -> Option<u64> {
        let path = format!("/proc/{}/status", self.child.id());
        let status = std::fs::read_to_string(path).ok()?;
        let value = status.lines().find_map(|line| line.strip_prefix(key))?;
        value.trim_end_matches("kB").trim().parse().ok()
    }

    /// Returns whether the process has not ended.
    pub fn is_running(&mut self) -> bool {
        self.child.try_wait().expect("a child can be asked").is_none()
    }

    /// Kills the process and waits for its end.
    pub fn kill(&mut self) {
        // The call fails only for a process that has ended already.
        let _ = self.child.kill();
        self.child.wait().expect("a child can be waited for");
    }

    /// Waits for the end of the process.
    #[track_caller]
    pub fn wait(&mut self) -> ExitStatus {
        until("the end of a process", || {
            self.child.try_wait().expect("a child can be asked")
        })
    }

    /// Returns the log, which also has the standard error of earlier processes with the same file.
    pub fn log(&self) -> String {
        String::from_utf8_lossy(&std::fs::read(&self.log).expect("the log can be read")).into_owned()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.kill();
    }
}
