//! Slurm: `squeue`, `sbatch`, `scancel`.

use super::pilot::{PilotSettings, Pilots};
use super::program::{Invocation, ProgramError};

/// The largest number of jobs in one array. Sites allow at least 1001, unless they have changed `MaxArraySize`.
const MAX_ARRAY_SIZE: u32 = 1000;

/// Returns the call that lists this user's jobs with the name: each on a line of its own, with its state.
pub(super) fn list(settings: &PilotSettings) -> Invocation {
    let name = format!("--name={}", settings.name);
    Invocation::new(
        "squeue",
        ["--noheader", "--me", "--array", &name, "--format=%i %T"],
    )
}

/// Reads the pilots from the answer; a completing job no longer counts.
pub(super) fn pilots(answer: &str) -> Result<Pilots, ProgramError> {
    let mut pilots = Pilots::default();
    for line in answer.lines() {
        let Some((job, state)) = line.trim().split_once(' ') else {
            return Err(ProgramError::Answer {
                program: "squeue",
                answer: line.to_owned(),
            });
        };
        match state {
            "PENDING" | "REQUEUED" | "REQUEUE_HOLD" | "SPECIAL_EXIT" => pilots.pending.push(job.to_owned()),
            "RUNNING" | "CONFIGURING" | "SUSPENDED" | "STOPPED" | "RESIZING" | "SIGNALING" => {
                pilots.running.push(job.to_owned());
            }
            _ => {}
        }
    }
    Ok(pilots)
}

/// Returns the calls that submit jobs as arrays.
pub(super) fn start(settings: &PilotSettings, script: &str, more: u32) -> Vec<Invocation> {
    let array = |first: u32| {
        let last = (more - first).min(MAX_ARRAY_SIZE) - 1;
        let arguments = [
            "--parsable".to_owned(),
            format!("--job-name={}", settings.name),
            format!("--array=0-{last}"),
            format!("--cpus-per-task={}", settings.threads),
        ];
        let arguments = arguments.into_iter().chain(settings.options.iter().cloned());
        Invocation {
            environment: settings.environment(),
            input: script.to_owned(),
            ..Invocation::new("sbatch", arguments)
        }
    };
    (0..more).step_by(MAX_ARRAY_SIZE as usize).map(array).collect()
}

/// Returns the call that cancels jobs.
pub(super) fn cancel(jobs: &[String]) -> Invocation {
    Invocation::new("scancel", jobs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> PilotSettings {
        PilotSettings {
            name: "grouser-worker".into(),
            coordinator: "http://keeper:7070".into(),
            worker: "worker".into(),
            threads: 4,
            max_idle_s: 120.0,
            token_file: Some("/home/me/farm.token".into()),
            ca_certificate: None,
            options: vec!["--partition=short".into()],
        }
    }

    #[test]
    fn jobs_are_pilots_by_their_states() {
        let answer = "12_0 RUNNING\n12_1 PENDING\n12_2 COMPLETING\n 13 CONFIGURING\n";
        let pilots = pilots(answer).unwrap();
        assert_eq!(pilots.running, ["12_0", "13"]);
        assert_eq!(pilots.pending, ["12_1"]);
        assert_eq!(super::pilots("").unwrap().count(), 0);
        let error = super::pilots("slurm_load_jobs").unwrap_err().to_string();
        assert_eq!(error, "squeue: unexpected answer \"slurm_load_jobs\"");
    }

    #[test]
    fn pilots_are_submitted_as_arrays_with_the_script_as_input() {
        let [first, second, third] = &start(&settings(), "#!/bin/sh\n", 2005)[..] else {
            panic!("three arrays");
        };
        assert_eq!(
            first.arguments,
            [
                "--parsable",
                "--job-name=grouser-worker",
                "--array=0-999",
                "--cpus-per-task=4",
                "--partition=short"
            ]
        );
        assert_eq!(second.arguments[2], "--array=0-999");
        assert_eq!(third.arguments[2], "--array=0-4");
        assert_eq!(first.input, "#!/bin/sh\n");
        let environment = [
            ("GROUSER_COORDINATOR", "http://keeper:7070".to_owned()),
            ("GROUSER_WORKER", "worker".to_owned()),
            ("GROUSER_THREADS", "4".to_owned()),
            ("GROUSER_MAX_IDLE", "120".to_owned()),
            ("GROUSER_TOKEN_FILE", "/home/me/farm.token".to_owned()),
        ];
        assert_eq!(first.environment, environment);
        assert!(start(&settings(), "", 0).is_empty());
    }
}
