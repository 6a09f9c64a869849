//! `coordinator scale` with programs that play Slurm, whose jobs are processes of this machine. `tests/engines` uses the real Slurm.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::wait::until_true;

/// Each job of the array is a process; its file has its number.
const SBATCH: &str = r#"#!/bin/sh
for option; do case $option in --array=0-*) last=${option#--array=0-} ;; esac; done
cat >"$QUEUE/script"
for task in $(seq 0 "$last"); do
    SLURM_JOB_ID=$$ SLURM_ARRAY_JOB_ID=$$ SLURM_ARRAY_TASK_ID=$task SLURM_CPUS_PER_TASK=1 \
        sh "$QUEUE/script" </dev/null >>"$QUEUE/pilots.log" 2>&1 &
    echo $! >"$QUEUE/$$_$task.job"
done
echo $$
"#;
const SQUEUE: &str = r#"#!/bin/sh
for job in "$QUEUE"/*.job; do
    [ -e "$job" ] || exit 0
    # The test and the program look at the queue at the same time.
    process=$(cat "$job" 2>/dev/null) || continue
    if kill -0 "$process" 2>/dev/null; then echo "$(basename "$job" .job) RUNNING"; else rm -f "$job"; fi
done
"#;
const SCANCEL: &str = r#"#!/bin/sh
for job; do kill "$(cat "$QUEUE/$job.job")"; done
"#;

/// `coordinator scale slurm` for a service, on a queue of its own.
struct Scaled {
    process: Process,
    queue: tempfile::TempDir,
}

impl Scaled {
    fn start(service: &Service, more: &[&str]) -> Scaled {
        let queue = tempfile::tempdir().expect("a folder");
        for (name, text) in [("sbatch", SBATCH), ("squeue", SQUEUE), ("scancel", SCANCEL)] {
            let file = queue.path().join(name);
            fs::write(&file, text).expect("a script");
            fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).expect("permissions");
        }
        let url = format!("http://{}", service.client.0);
        let words_before = [
            "scale",
            "slurm",
            "--url",
            &url,
            "--max",
            "2",
            "--every",
            "0.1",
            "--finish-within",
            "0.01",
        ];
        let mut command = programs::coordinator(words_before.into_iter().chain(more.iter().copied()));
        with(&mut command, queue.path());
        let process = Process::start(command, &queue.path().join("scale.log"));
        Scaled { process, queue }
    }

    /// Numbers of the processes that play jobs.
    fn jobs(&self) -> usize {
        let mut command = Command::new(self.queue.path().join("squeue"));
        with(&mut command, self.queue.path());
        programs::run(command).success().lines().count()
    }
}

/// Puts the test's queue first in PATH, and sets the tested program as the worker.
fn with(command: &mut Command, queue: &Path) {
    let worker = programs::worker([] as [&str; 0]);
    let path = std::env::var("PATH").unwrap_or_default();
    command
        .env("PATH", format!("{}:{path}", queue.display()))
        .env("QUEUE", queue)
        .env("GROUSER_WORKER", worker.get_program());
}

#[test]
fn pilots_come_with_the_work_and_go_when_it_is_done() {
    let service = Service::start(&[]);
    let mut scaled = Scaled::start(&service, &["--max-idle", "0.5"]);
    let id = service.submit(&Job::rolling());
    until_true("two pilots", || scaled.jobs() == 2);
    until_true("the end", || service.status(id)["state"] == "finished");
    until_true("no pilot", || scaled.jobs() == 0);
    scaled.process.signal(Signal::Terminate);
    assert!(scaled.process.wait().success(), "{}", scaled.process.log());
}

#[test]
fn the_cap_of_cost_ends_all_pilots() {
    let service = Service::start(&[]);
    service.submit(&Job::rolling().sampler(5000, [2, 4], 1));
    // The cap is three seconds of a thread.
    let mut scaled = Scaled::start(&service, &["--cost-cap-thread-h", "0.00083"]);
    assert!(scaled.process.wait().success(), "{}", scaled.process.log());
    let log = scaled.process.log();
    assert_contains!(log, "of 0.00083 thread-hours: all are ended");
    until_true("no pilot", || scaled.jobs() == 0);
}

#[test]
fn pilots_that_end_without_a_word_are_not_started_again_and_again() {
    // A local worker computes meanwhile.
    let service = Service::start(&["--local-workers", "1"]);
    service.submit(&Job::rolling().sampler(5000, [2, 4], 1));
    let mut scaled = Scaled::start(&service, &["--worker", "/bin/false"]);
    until_true("the warning", || {
        let log = scaled.process.log();
        log.contains("and none has sent a result")
    });
    assert_contains!(scaled.process.log(), "started in 10 s");
    assert!(scaled.process.is_running());
}

#[test]
fn what_cannot_be_done_is_said() {
    let service = Service::start(&[]);
    let url = format!("http://{}", service.client.0);
    let refusal = |words: &[&str]| {
        let words_before = ["scale", "--url", &url, "--once"];
        let mut command = programs::coordinator(words_before.into_iter().chain(words.iter().copied()));
        command.env("PATH", "/nowhere");
        programs::run(command).refusal()
    };
    let missing = refusal(&["slurm", "--max", "2"]);
    assert_contains!(missing, "squeue: cannot be run; is it installed, and in PATH?");
    let bounds = refusal(&["slurm", "--min", "3", "--max", "2"]);
    assert_eq!(bounds, "--min 3 must be at most --max 2");
    let script = refusal(&["hyperqueue", "--max", "2", "--script", "x"]);
    assert_eq!(script, "--script: only Slurm has batch scripts");
}
