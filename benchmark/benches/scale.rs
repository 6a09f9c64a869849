//! How many workers one coordinator serves: the real queue, dispatcher and store, without HTTP.
//!
//! `cargo bench -p benchmark --bench scale`, or with `-- WORKERS SECONDS` for one farm. Each worker is a task that exchanges results for
//! leases and sleeps for the time of its evaluations. Like a `worker` with one thread, it holds leases for 1.5 s of work, at least one,
//! and renews them. The store is a real file, and an answer waits until it is durable. The bench `throughput` includes HTTP.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use benchmark::error::StudyError;
use benchmark::farm_load::{EXPERIMENT, RUNS, job, quantile, request, results};
use benchmark::process::{cpu_s, memory_kb};
use coordinator::service::{FarmSettings, Service};
use farm::calibration::VerificationRule;
use shared::api::{NewCalibration, NewExperiment};
use shared::exchange::WorkResult;
use shared::outcome::{Observables, Outcome};

/// The number of workers and the seconds of an evaluation of each farm.
const FARMS: [(usize, f64); 8] = [
    (100, 0.1),
    (1_000, 1.0),
    (1_000, 0.1),
    (10_000, 10.0),
    (10_000, 1.0),
    (20_000, 1.0),
    (30_000, 1.0),
    (100_000, 10.0),
];
/// The time of the work that a worker holds `[s]`.
const HELD_S: f64 = 1.5;
/// The time in which the workers start one after another, and nothing is counted `[s]`.
const START_S: f64 = 12.0;
/// The time in which everything is counted `[s]`.
const COUNTED_S: f64 = 15.0;
const LEASE_MS: u64 = 15_000;
const CALIBRATIONS: usize = 12;

/// Counts of a farm while they are taken.
#[derive(Default)]
struct Counted {
    is_counting: AtomicU64,
    evaluations: AtomicU64,
    exchanges: AtomicU64,
}

#[tokio::main]
async fn main() -> Result<(), StudyError> {
    println!(
        "{:>8} {:>13} {:>12} {:>14} {:>12} {:>8} {:>8} {:>7} {:>8} {:>13} {:>9}",
        "workers",
        "evaluation s",
        "at most /s",
        "evaluations/s",
        "exchanges/s",
        "p50 ms",
        "p99 ms",
        "cores",
        "MB",
        "bytes / eval.",
        "restart s"
    );
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    if let [workers, evaluation_s] = &words[..] {
        return farm(workers.parse()?, evaluation_s.parse()?).await;
    }
    for (workers, evaluation_s) in FARMS {
        farm(workers, evaluation_s).await?;
    }
    Ok(())
}

async fn farm(workers: usize, evaluation_s: f64) -> Result<(), StudyError> {
    let folder = tempfile::tempdir()?;
    let store = folder.path().join("scale.db");
    let settings = FarmSettings {
        lease_ms: LEASE_MS,
        rule: VerificationRule::default(),
    };
    let service = Service::open(&store.display().to_string(), settings.clone()).await?;
    let files = [("runs.csv".to_owned(), RUNS.to_owned())].into();
    let toml = EXPERIMENT.to_owned();
    let experiment = service.add_experiment(NewExperiment { toml, files }).await?;
    for _ in 0..CALIBRATIONS {
        let new = NewCalibration {
            experiment,
            toml: job(),
            files: Default::default(),
            name: None,
            webhook: None,
        };
        service.add_calibration(new).await?;
    }
    let counted = Arc::new(Counted::default());
    let empty_bytes = bytes(&store)?;
    let ends = Instant::now() + Duration::from_secs_f64(START_S + COUNTED_S);
    let tasks: Vec<_> = (0..workers)
        .map(|number| {
            let begins_s = START_S * 0.8 * number as f64 / workers as f64;
            tokio::spawn(work(
                service.clone(),
                number,
                begins_s,
                evaluation_s,
                ends,
                counted.clone(),
            ))
        })
        .collect();
    tokio::time::sleep(Duration::from_secs_f64(START_S)).await;
    counted.is_counting.store(1, Ordering::Relaxed);
    let (cpu_before_s, began) = (cpu_s("self")?, Instant::now());
    tokio::time::sleep(Duration::from_secs_f64(COUNTED_S)).await;
    counted.is_counting.store(0, Ordering::Relaxed);
    let seconds = began.elapsed().as_secs_f64();
    let cores = (cpu_s("self")? - cpu_before_s) / seconds;
    let (mut times_ms, mut all) = (Vec::new(), 0_u64);
    for task in tasks {
        let (worker_ms, evaluations) = task.await??;
        times_ms.extend(worker_ms);
        all += evaluations;
    }
    if times_ms.is_empty() {
        return Err("nothing was counted: the work had run out".into());
    }
    times_ms.sort_by(f32::total_cmp);
    let resident_mb = memory_kb("self", "VmRSS")? as f64 / 1000.0;
    service.close().await;
    // All calibrations are in progress, so that the start replays every evaluation.
    let began = Instant::now();
    let service = Service::open(&store.display().to_string(), settings).await?;
    let restart_s = began.elapsed().as_secs_f64();
    println!(
        "{workers:>8} {evaluation_s:>13} {:>12.0} {:>14.0} {:>12.0} {:>8.2} {:>8.1} {cores:>7.2} {resident_mb:>8.0} {:>13.0} {restart_s:>9.1}",
        workers as f64 / evaluation_s,
        counted.evaluations.load(Ordering::Relaxed) as f64 / seconds,
        counted.exchanges.load(Ordering::Relaxed) as f64 / seconds,
        quantile(&times_ms, 0.5),
        quantile(&times_ms, 0.99),
        (bytes(&store)? - empty_bytes) as f64 / all as f64,
    );
    service.close().await;
    Ok(())
}

/// Plays a worker; returns the times of the counted exchanges `[ms]`, and the number of all its evaluations.
async fn work(
    service: Service,
    number: usize,
    begins_s: f64,
    evaluation_s: f64,
    ends: Instant,
    counted: Arc<Counted>,
) -> Result<(Vec<f32>, u64), StudyError> {
    tokio::time::sleep(Duration::from_secs_f64(begins_s)).await;
    let want = (HELD_S / evaluation_s).max(1.0) as u32;
    let outcome = Outcome::Evaluated(Observables {
        drawbar_pull_n: vec![29.5],
        ..Observables::default()
    });
    let request = |results, holding, want, received| {
        let mut request = request(format!("scale-{number}"), results, received, want, 30_000);
        (request.evaluation_s, request.holding) = (Some(evaluation_s), holding);
        request
    };
    let (mut times_ms, mut all, mut received) = (Vec::new(), 0, 0);
    let mut done: Vec<WorkResult> = Vec::new();
    while Instant::now() < ends {
        let (count, sent) = (done.len() as u64, Instant::now());
        let message = request(std::mem::take(&mut done), Vec::new(), want, received);
        let response = service.exchange(message).await?;
        if counted.is_counting.load(Ordering::Relaxed) == 1 {
            times_ms.push(sent.elapsed().as_secs_f32() * 1e3);
            counted.evaluations.fetch_add(count, Ordering::Relaxed);
            counted.exchanges.fetch_add(1, Ordering::Relaxed);
        }
        all += count;
        received = response.leases.iter().map(|l| l.lease).max().unwrap_or(received);
        // Like a worker, it renews its leases after every third of their time.
        let mut left = Duration::from_secs_f64(evaluation_s * response.leases.len() as f64);
        let renewal = Duration::from_millis(LEASE_MS / 3);
        while left > renewal {
            tokio::time::sleep(renewal).await;
            left -= renewal;
            let holding = response.leases.iter().map(|l| l.lease).collect();
            service
                .exchange(request(Vec::new(), holding, 0, received))
                .await?;
        }
        tokio::time::sleep(left).await;
        done = results(response.leases, &outcome);
    }
    Ok((times_ms, all))
}

/// Size of the store with its log `[bytes]`.
fn bytes(store: &Path) -> Result<u64, StudyError> {
    let log = store.with_extension("db-wal");
    Ok(std::fs::metadata(store)?.len() + std::fs::metadata(log).map_or(0, |m| m.len()))
}
