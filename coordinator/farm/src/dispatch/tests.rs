//! Tests of the farm's thread while steps are under way: each step waits for the test.

use std::sync::Mutex;

use super::*;
use crate::calibration::{CalibrationIdentity, Stepped};
use job::Spec;
use shared::exchange::{Lease, PROTOCOL_VERSION, WorkResult};
use shared::file::FileSet;
use shared::outcome::{Observables, Outcome};

const JOB: &str = "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\nn = { uniform = [0.8, 1.4] }\nfriction_angle_deg = 30.0\n[sampler]\nparticles = 20\nmoves = [2, 4]\n";
const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 0.05\n";
const RUNS: &str =
    "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,5.0\n";
const KEY: SealKey = SealKey([1; 16]);

fn calibration(id: i64) -> Calibration {
    calibration_of(id, JOB)
}

fn calibration_of(id: i64, job: &str) -> Calibration {
    let files = |toml: &str, files| FileSet {
        toml: toml.into(),
        files,
    };
    let runs = [("runs.csv".to_owned(), RUNS.to_owned())].into();
    let spec = Spec::new(
        "job.toml",
        &files(job, Default::default()),
        "experiment.toml",
        &files(EXPERIMENT, runs),
    );
    let identity = CalibrationIdentity {
        id,
        name: "toy".into(),
        study: id,
        experiment: 1,
    };
    Calibration::new(identity, Arc::new(spec.expect("the job is valid"))).expect("it begins")
}

/// A farm whose steps wait for the test.
struct Halted {
    dispatcher: Dispatcher,
    /// What each step does when it has begun; without a sender, it fails.
    go: mpsc::Sender<bool>,
    begun: mpsc::Receiver<i64>,
}

impl Halted {
    fn start() -> Halted {
        let (go, may_go) = mpsc::channel::<bool>();
        let (tell_begun, begun) = mpsc::channel();
        let locks = Mutex::new((may_go, tell_begun));
        let take = move |step: Step| -> Stepped {
            let lock = locks.lock().expect("no step panics under the lock");
            lock.1.send(step.calibration()).expect("the test waits");
            let goes = lock.0.recv().expect("the test lives");
            drop(lock);
            assert!(goes, "as the test wants");
            step.run()
        };
        let sink: FactSink = Box::new(|_| Some(0));
        let take: TakeStep = Arc::new(take);
        let started = Dispatcher::start_with(Farm::new(1, 60_000), sink, &take);
        let (dispatcher, _) = started.expect("threads start");
        Halted {
            dispatcher,
            go,
            begun,
        }
    }

    async fn exchange(&self, results: Vec<WorkResult>, want: u32, wait_ms: u64) -> ExchangeResponse {
        let request = request(results, want, wait_ms);
        self.dispatcher.exchange(request).await.expect("the farm runs").0
    }

    /// Answers a round, whose last results are sent with a wish for more.
    async fn answer_round(&self, id: i64) -> ExchangeResponse {
        self.dispatcher
            .add(calibration(id), KEY, Vec::new())
            .await
            .expect("the farm runs");
        let leases = self.exchange(Vec::new(), 20, 0).await.leases;
        assert_eq!(leases.len(), 20);
        self.exchange(answers(leases), 20, 0).await
    }
}

fn request(results: Vec<WorkResult>, want: u32, wait_ms: u64) -> ExchangeRequest {
    ExchangeRequest {
        worker: "w".into(),
        protocol: PROTOCOL_VERSION,
        model_version: "toy-1".into(),
        models: Default::default(),
        queue_job: None,
        threads: 1,
        evaluation_s: None,
        results,
        holding: Vec::new(),
        returned: Vec::new(),
        started: Vec::new(),
        received: u64::MAX,
        want,
        wait_ms,
    }
}

fn answers(leases: Vec<Lease>) -> Vec<WorkResult> {
    let result = |lease: Lease| WorkResult {
        lease: lease.lease,
        calibration: lease.calibration,
        evaluation: lease.evaluation,
        seal: lease.seal,
        outcome: outcome(lease.theta[0]),
        repeated: None,
    };
    leases.into_iter().map(result).collect()
}

fn outcome(value: f64) -> Outcome {
    Outcome::Evaluated(Observables {
        drawbar_pull_n: vec![value],
        torque_n_m: vec![1.0],
        sinkage_m: vec![0.01],
        lateral_force_n: vec![0.0],
        b_eff_m: vec![0.03],
        contact_length_m: vec![0.04],
        residual_load_n: vec![0.0],
        nodes_in_contact: vec![16],
        simulated_travel_m: vec![0.0],
        ..Observables::default()
    })
}

#[tokio::test]
async fn the_farm_answers_everybody_while_a_step_is_under_way() {
    let farm = Halted::start();
    let answer = farm.answer_round(1).await;
    assert_eq!((answer.leases.len(), answer.remaining, answer.in_hand), (0, 0, 1));
    assert_eq!(farm.begun.recv(), Ok(1));
    // The step has begun and waits for this test. All of this is answered meanwhile.
    let status = farm
        .dispatcher
        .status(1)
        .await
        .expect("the farm runs")
        .expect("it is in progress");
    assert_eq!(status.state, CalibrationState::Running);
    assert_eq!(status.progress.map(|p| p.evaluations), Some(20));
    assert_eq!(
        farm.dispatcher.metrics().await.expect("the farm runs").stepping,
        1
    );
    assert!(farm.exchange(Vec::new(), 20, 0).await.leases.is_empty());
    assert_eq!(farm.dispatcher.demand().await.expect("the farm runs").queued, 0);
    farm.go.send(true).expect("the step waits");
    // A parked poll is answered when the next round is proposed.
    assert!(!farm.exchange(Vec::new(), 20, 60_000).await.leases.is_empty());
    assert_eq!(
        farm.dispatcher.metrics().await.expect("the farm runs").stepping,
        0
    );
    farm.dispatcher.stop();
}

#[tokio::test]
async fn a_step_that_panics_pauses_its_calibration_alone() {
    let farm = Halted::start();
    farm.answer_round(1).await;
    assert_eq!(farm.begun.recv(), Ok(1));
    farm.go.send(false).expect("the step waits");
    farm.answer_round(2).await;
    assert_eq!(farm.begun.recv(), Ok(2));
    farm.go.send(true).expect("the step waits");
    assert!(!farm.exchange(Vec::new(), 20, 60_000).await.leases.is_empty());
    let status = loop {
        let status = farm
            .dispatcher
            .status(1)
            .await
            .expect("the farm runs")
            .expect("it is in progress");
        if status.state == CalibrationState::Paused {
            break status;
        }
    };
    let message = status.message.unwrap_or_default();
    assert!(
        message.ends_with("by an error of the program: as the test wants"),
        "{message}"
    );
    farm.dispatcher.stop();
}

#[tokio::test]
async fn a_waiting_step_of_a_cancelled_calibration_is_not_taken() {
    let farm = Halted::start();
    let threads = std::thread::available_parallelism().map_or(2, usize::from).max(2) as i64;
    // Each thread has a step; two more wait.
    let (cancelled, last) = (threads + 1, threads + 2);
    for id in 1..=last {
        farm.answer_round(id).await;
    }
    let control = farm.dispatcher.control(cancelled, Control::Cancel).await;
    control.expect("the farm runs").expect("it is in progress");
    for _ in 1..last {
        farm.go.send(true).expect("a step waits");
    }
    let mut taken: Vec<i64> = (1..last).map(|_| farm.begun.recv().expect("a step")).collect();
    taken.sort_unstable();
    assert_eq!(taken, (1..=threads).chain([last]).collect::<Vec<_>>());
    farm.dispatcher.stop();
}

#[test]
fn the_step_of_an_emulated_sampler_is_long() {
    for (stages, is_long) in [("moves = [2, 4]", false), ("stages = \"emulated\"", true)] {
        let mut farm = Farm::new(1, 60_000);
        let calibration = calibration_of(1, &JOB.replace("moves = [2, 4]", stages));
        farm.add(calibration, KEY, Vec::new(), 0);
        let leases = farm.exchange(request(Vec::new(), 1_000, 0), 0).leases;
        farm.exchange(request(answers(leases), 0, 0), 0);
        let step = farm.take_steps().pop().expect("the round is over");
        assert_eq!(step.is_long(), is_long, "{stages}");
    }
}
