//! HyperQueue: `hq submit`, `hq job list`, `hq job cancel`.
//!
//! A pilot is a job of one task. Machines are those of HyperQueue's own workers, which its allocator (`hq alloc add slurm`, `hq alloc add
//! pbs`) or a user starts.

use serde::Deserialize;

use super::pilot::{PilotSettings, Pilots};
use super::program::{Invocation, ProgramError};

/// A job in the answer of `hq job list`.
#[derive(Deserialize)]
struct Job {
    id: u64,
    name: String,
    task_stats: Tasks,
}

#[derive(Deserialize)]
struct Tasks {
    running: u64,
    waiting: u64,
}

/// Returns the call that lists the jobs that have not ended.
pub(super) fn list() -> Invocation {
    Invocation::new("hq", ["--output-mode=json", "job", "list"])
}

/// Reads the pilots from the answer.
pub(super) fn pilots(answer: &str, settings: &PilotSettings) -> Result<Pilots, ProgramError> {
    let jobs: Vec<Job> = serde_json::from_str(answer).map_err(|_| ProgramError::Answer {
        program: "hq",
        answer: answer.trim().to_owned(),
    })?;
    let mut pilots = Pilots::default();
    for job in jobs.into_iter().filter(|job| job.name == settings.name) {
        if job.task_stats.running > 0 {
            pilots.running.push(job.id.to_string());
        } else if job.task_stats.waiting > 0 {
            pilots.pending.push(job.id.to_string());
        }
    }
    Ok(pilots)
}

/// Returns the call that submits `more` jobs, each by itself, so that single ones can be cancelled.
pub(super) fn start(settings: &PilotSettings, more: u32) -> Vec<Invocation> {
    let mut arguments = vec![
        "submit".to_owned(),
        format!("--name={}", settings.name),
        format!("--cpus={}", settings.threads),
    ];
    for (name, value) in settings.environment() {
        arguments.push(format!("--env={name}={value}"));
    }
    arguments.extend(settings.options.iter().cloned());
    arguments.extend(["--".to_owned(), settings.worker.clone()]);
    vec![Invocation::new("hq", arguments); more as usize]
}

/// Returns the call that cancels jobs.
pub(super) fn cancel(jobs: &[String]) -> Invocation {
    Invocation::new("hq", ["job".to_owned(), "cancel".to_owned(), jobs.join(",")])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> PilotSettings {
        PilotSettings {
            name: "grouser-worker".into(),
            coordinator: "http://keeper:7070".into(),
            worker: "worker".into(),
            threads: 2,
            max_idle_s: 60.0,
            token_file: None,
            ca_certificate: None,
            options: vec!["--time-request=1h".into()],
        }
    }

    #[test]
    fn jobs_of_the_name_are_pilots() {
        let answer = r#"[
            {"id": 1, "name": "grouser-worker", "task_count": 1, "task_stats": {"running": 1, "finished": 0, "waiting": 0}},
            {"id": 2, "name": "grouser-worker", "task_count": 1, "task_stats": {"running": 0, "finished": 0, "waiting": 1}},
            {"id": 3, "name": "another", "task_count": 1, "task_stats": {"running": 1, "finished": 0, "waiting": 0}}]"#;
        let pilots = pilots(answer, &settings()).unwrap();
        assert_eq!(
            (pilots.running, pilots.pending),
            (vec!["1".into()], vec!["2".into()])
        );
        assert!(super::pilots("No jobs", &settings()).is_err());
    }

    #[test]
    fn each_pilot_is_a_job_of_its_own() {
        let started = start(&settings(), 2);
        assert_eq!(started.len(), 2);
        assert_eq!(
            started[0].arguments,
            [
                "submit",
                "--name=grouser-worker",
                "--cpus=2",
                "--env=GROUSER_COORDINATOR=http://keeper:7070",
                "--env=GROUSER_WORKER=worker",
                "--env=GROUSER_THREADS=2",
                "--env=GROUSER_MAX_IDLE=60",
                "--time-request=1h",
                "--",
                "worker"
            ]
        );
    }
}
