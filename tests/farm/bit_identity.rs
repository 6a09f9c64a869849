//! The posterior is a function of the job alone: it has the same bytes on any workers, and after any kill of a program.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::whole;
use farm_tests::process::{Process, Signal};
use farm_tests::programs;
use farm_tests::random::Random;
use farm_tests::service::{Service, free_address};
use farm_tests::text::same;
use farm_tests::wait::{until, until_true};
use farm_tests::workspace::text;

/// The number of kills.
const KILLS: u64 = 24;

/// Returns a job with many stages, so that the kills fall into different ones, and of a few seconds.
fn job() -> Job {
    Job::small().sampler(1000, [4, 10], 3)
}

/// Returns the results of one worker with one thread: the posterior, evaluations by the end of sampling, stages.
fn reference() -> &'static (String, u64, usize) {
    static REFERENCE: OnceLock<(String, u64, usize)> = OnceLock::new();
    REFERENCE.get_or_init(|| {
        let service = Service::start(&[]);
        let id = service.submit(&job());
        let _worker = service.worker("worker", 1);
        service.wait_for(id, "finished");
        let summary = service.result(id, "summary");
        let evaluations = whole(&summary["calibrations"][0]["evaluations"]);
        let stages = summary["calibrations"][0]["stages"]
            .as_array()
            .expect("stages")
            .len();
        (service.posterior_csv(id), evaluations, stages)
    })
}

#[test]
fn three_workers_of_two_threads_give_the_bytes_of_one_worker_of_one_thread() {
    let (expected, ..) = reference();
    let service = Service::start(&["--verify-percent", "10"]);
    let id = service.submit(&job());
    let _workers = ["a", "b", "c"].map(|name| service.worker(name, 2));
    service.wait_for(id, "finished");
    same(&service.posterior_csv(id), expected);
    assert_eq!(expected.lines().count(), 1001);
}

#[test]
fn another_seed_gives_other_bytes() {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.calibrate(&Job::small().sampler(200, [4, 10], 4));
    assert!(service.posterior_csv(id) != reference().0);
}

/// The program that is killed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Victim {
    Coordinator,
    Worker,
    Both,
}

#[test]
fn killing_coordinator_and_workers_at_random_moments_changes_no_byte() {
    let (expected, total, stages) = reference();
    let mut service = Service::start(&["--lease-ms", "500", "--verify-percent", "10"]);
    let id = service.submit(&job());
    let mut workers: Vec<Process> = (0..2)
        .map(|k| service.worker(&format!("worker-{k}"), 1))
        .collect();
    let mut random = Random::new(20_070_816);
    let mut moments: Vec<u64> = (0..KILLS)
        .map(|_| total / 50 + random.below(total * 24 / 25))
        .collect();
    // The last kill falls among the final draws, after the evaluations of the sampler.
    moments.push(total + 40);
    moments.sort_unstable();
    let mut kills: Vec<(Victim, u64, u64)> = Vec::new();
    for moment in moments {
        // There must be progress since the last kill, so that no two kills hit the same state.
        let least = kills
            .last()
            .map_or(moment, |&(_, evaluations, _)| moment.max(evaluations + 1));
        let (evaluations, stage) = until("progress", || {
            let status = service.status(id);
            assert_ne!(status["state"], "paused", "{status}");
            let progress = &status["progress"];
            let evaluations = progress["evaluations"].as_u64()?;
            (evaluations >= least).then(|| {
                (
                    evaluations,
                    progress["position"]["stage"].as_u64().unwrap_or_default(),
                )
            })
        });
        std::thread::sleep(Duration::from_millis(random.below(20)));
        let last = kills.len() as u64 == KILLS;
        let victim = if last { 2 } else { random.below(3) as usize };
        let victim = [Victim::Coordinator, Victim::Worker, Victim::Both][victim];
        if victim != Victim::Worker {
            service.kill();
        }
        if victim != Victim::Coordinator {
            let k = random.below(2) as usize;
            workers[k].kill();
            workers[k] = service.worker(&format!("worker-{k}"), 1);
        }
        if victim != Victim::Worker {
            service.restart();
        }
        kills.push((victim, evaluations, stage));
    }
    service.wait_for(id, "finished");
    for victim in [Victim::Coordinator, Victim::Worker, Victim::Both] {
        assert!(kills.iter().filter(|k| k.0 == victim).count() >= 4, "{kills:?}");
    }
    let mut hit: Vec<u64> = kills.iter().map(|&(_, _, stage)| stage).collect();
    hit.dedup();
    assert!(
        hit.len() * 3 >= stages * 2,
        "kills hit {hit:?} of {stages} stages"
    );
    assert!(kills.windows(2).all(|pair| pair[0].1 < pair[1].1), "{kills:?}");
    same(&service.posterior_csv(id), expected);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
}

/// A `coordinator run` of the same job in a folder of its own.
struct Run {
    folder: tempfile::TempDir,
    job: PathBuf,
}

impl Run {
    fn new() -> Run {
        Run::with_job(&job())
    }

    fn with_job(job: &Job) -> Run {
        let folder = tempfile::tempdir().expect("a folder");
        let job = job.write(&folder.path().join("job"));
        Run { folder, job }
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    fn arguments(&self) -> Vec<String> {
        let path = |p: &Path| p.display().to_string();
        [
            "run".into(),
            path(&self.job),
            "--out".into(),
            path(&self.out()),
            "--local-workers".into(),
            "2".into(),
        ]
        .into()
    }

    fn start(&self) -> Process {
        Process::start(quiet(&self.arguments()), &self.folder.path().join("run.log"))
    }

    /// Returns the number of stages in the log of the run.
    fn stages_begun(process: &Process) -> usize {
        process
            .log()
            .lines()
            .filter(|line| line.contains(", stage "))
            .count()
    }

    /// Runs to the end; returns the standard output.
    fn finish(&self) -> String {
        programs::run(programs::coordinator(self.arguments())).success()
    }

    fn posterior(&self) -> String {
        text(&self.out().join("posterior.csv"))
    }
}

fn quiet(arguments: &[String]) -> std::process::Command {
    let mut command = programs::coordinator(arguments);
    command.stdout(std::process::Stdio::null());
    command
}

#[test]
fn a_run_stopped_by_interrupt_or_kill_goes_on_to_the_same_bytes() {
    // The progress display is updated every 100 ms, and each of the six stages must last for several updates to be shown.
    let slow = Job::small().sampler(3000, [4, 10], 3);
    let undisturbed = Run::with_job(&slow);
    undisturbed.finish();
    for signal in [Signal::Interrupt, Signal::Terminate, Signal::Kill] {
        let run = Run::with_job(&slow);
        // The first stop is in stage 2, and the second as soon as the resumed run shows its stage, well before the end.
        for (stop, stages) in [(1, 2), (2, 1)] {
            let mut process = run.start();
            let shown = Run::stages_begun(&process);
            until_true("a stage of the run", || {
                assert!(
                    process.is_running(),
                    "the run ended too early:\n{}",
                    process.log()
                );
                Run::stages_begun(&process) >= shown + stages
            });
            process.signal(signal);
            let ended = process.wait();
            let status = match signal {
                Signal::Interrupt => Some(130),
                Signal::Terminate => Some(143),
                _ => None,
            };
            assert_eq!(
                ended.code(),
                status,
                "{signal:?}, stop {stop}:\n{}",
                process.log()
            );
            assert!(
                !run.out().join("posterior.csv").exists(),
                "a result of an unfinished run"
            );
        }
        let table = run.finish();
        assert_contains!(table, "root mean sq. error");
        same(&run.posterior(), &undisturbed.posterior());
    }
}

#[test]
fn a_run_whose_workers_are_all_elsewhere_gives_the_same_bytes() {
    let run = Run::new();
    let address = free_address();
    let arguments = [
        &run.arguments()[..4],
        &[
            "--local-workers".into(),
            "0".into(),
            "--listen".into(),
            address.clone(),
        ],
    ];
    let mut process = Process::start(quiet(&arguments.concat()), &run.folder.path().join("run.log"));
    let log = |name: &str| run.folder.path().join(name);
    let _workers = ["a", "b"].map(|name| Process::worker(&format!("http://{address}"), 1, &log(name)));
    assert!(process.wait().success(), "{}", process.log());
    same(&run.posterior(), &reference().0);
}

#[test]
fn a_finished_run_prints_its_result_again_and_a_changed_job_is_refused() {
    let run = Run::new();
    let first = run.finish();
    let written = run.posterior();
    same(&written, &reference().0);
    same(&run.finish(), &first);

    let commented = job().in_job("[sampler]", "# A comment changes nothing.\n[sampler]");
    commented.write(run.job.parent().expect("the job's folder"));
    same(&run.finish(), &first);

    for changed in [
        job().in_job("seed = 3", "seed = 5"),
        job().in_job("[11.5, 37.3]", "[11.5, 37.4]"),
        job().in_runs("24.34576", "24.34577"),
        job().in_experiment("torque_n_m = 0.15", "torque_n_m = 0.16"),
    ] {
        changed.write(run.job.parent().expect("the job's folder"));
        let message = programs::run(programs::coordinator(run.arguments())).refusal();
        assert_contains!(
            message,
            "another job",
            "has changed since",
            run.out().display().to_string()
        );
        same(&run.posterior(), &written);
    }
}
