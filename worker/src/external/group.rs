//! The processes of a program: a group that is killed as a whole, within limits.
//!
//! A group is killed when its leader ends, even if the leader has started other processes, and when the worker stops. The
//! limits are those of the system: address space by `RLIMIT_AS`, and CPU time by `RLIMIT_CPU`, which also ends processes
//! that outlive a killed worker.

use std::process::{Child, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rustix::process::{
    Pid, Resource, Rlimit, Signal, WaitId, WaitIdOptions, kill_process_group, prlimit, waitid,
};

/// The interval of polling for the end of a leader that has closed its output.
const LOOK: Duration = Duration::from_millis(1);

/// The running groups.
#[derive(Debug, Default)]
pub(super) struct ProcessGroups(Mutex<Running>);

#[derive(Debug, Default)]
struct Running {
    leaders: Vec<Pid>,
    is_stopped: bool,
}

/// Why a process is not accepted.
#[derive(Debug, thiserror::Error)]
pub(super) enum GroupError {
    /// The worker no longer starts processes.
    #[error("the worker stops")]
    Stopped,
    /// The process number of the operating system is invalid.
    #[error("process {0} has no group")]
    Number(u32),
}

pub(super) struct ProcessGroup<'a> {
    child: Child,
    leader: Pid,
    groups: &'a ProcessGroups,
}

impl ProcessGroups {
    /// Accepts a process that leads a group; on a [`GroupError`] the process is killed.
    pub(super) fn take(&self, mut child: Child) -> Result<ProcessGroup<'_>, GroupError> {
        let leader = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
        let mut running = self.lock();
        let refused = match leader {
            Some(leader) if !running.is_stopped => {
                running.leaders.push(leader);
                let groups = self;
                return Ok(ProcessGroup {
                    child,
                    leader,
                    groups,
                });
            }
            Some(_) => GroupError::Stopped,
            None => GroupError::Number(child.id()),
        };
        // The process may have ended already.
        let _ = child.kill();
        let _ = child.wait();
        Err(refused)
    }

    /// Kills every running group, and accepts no more.
    pub(super) fn stop(&self) {
        let mut running = self.lock();
        running.is_stopped = true;
        for leader in running.leaders.drain(..) {
            kill(leader);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Running> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn kill(leader: Pid) {
    // The group may have ended already.
    let _ = kill_process_group(leader, Signal::KILL);
}

impl ProcessGroup<'_> {
    /// Limits address space `[MB]` and CPU time. The program cannot have done any work yet, because it has no input.
    pub(super) fn limit(&self, memory_mb: Option<u64>, time: Duration) -> Result<(), rustix::io::Errno> {
        let set = |resource, max: u64| {
            let limit = Rlimit {
                current: Some(max),
                maximum: Some(max),
            };
            prlimit(Some(self.leader), resource, limit).map(drop)
        };
        if let Some(memory_mb) = memory_mb {
            set(Resource::As, memory_mb.saturating_mul(1_000_000))?;
        }
        set(Resource::Cpu, time.as_secs() + 2)
    }

    /// Waits for the end of the leader until a time, kills the rest of the group, and returns the leader's status; `None` on
    /// timeout.
    pub(super) fn end(&mut self, until: Instant) -> std::io::Result<Option<ExitStatus>> {
        let seen = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        let has_ended = loop {
            let has_ended = waitid(WaitId::Pid(self.leader), seen)?.is_some();
            if has_ended || Instant::now() >= until {
                break has_ended;
            }
            std::thread::sleep(LOOK);
        };
        // The system cannot reuse the group's number until the leader is waited for.
        kill(self.leader);
        self.groups.lock().leaders.retain(|leader| *leader != self.leader);
        let status = self.child.wait()?;
        Ok(has_ended.then_some(status))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;
    use std::os::unix::process::CommandExt;
    use std::process::{ChildStdout, Command, Stdio};

    use super::*;

    /// Starts a process and a child, both of which sleep and hold standard output.
    fn sleeper() -> Child {
        let mut command = Command::new("sh");
        command.args(["-c", "sleep 600 & sleep 600"]).process_group(0);
        command.stdout(Stdio::piped()).spawn().unwrap()
    }

    /// Waits until no process holds the other end.
    fn drained(output: Option<ChildStdout>) {
        output.unwrap().read_to_end(&mut Vec::new()).unwrap();
    }

    #[test]
    fn a_group_that_runs_is_killed_by_the_stop_and_none_begins_after_it() {
        let groups = ProcessGroups::default();
        let mut child = sleeper();
        let output = child.stdout.take();
        let mut group = groups.take(child).unwrap();
        groups.stop();
        drained(output);
        let status = group.end(Instant::now() + Duration::from_secs(60)).unwrap();
        assert!(status.is_some_and(|status| !status.success()));
        assert!(matches!(groups.take(sleeper()), Err(GroupError::Stopped)));
    }

    #[test]
    fn the_rest_of_a_group_is_killed_at_its_time_limit() {
        let groups = ProcessGroups::default();
        let mut child = sleeper();
        let output = child.stdout.take();
        let mut group = groups.take(child).unwrap();
        assert_eq!(group.end(Instant::now()).unwrap(), None);
        drained(output);
        assert!(groups.lock().leaders.is_empty());
    }
}
