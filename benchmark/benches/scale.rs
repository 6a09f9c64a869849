//! How many workers one coordinator carries: the real queue, dispatcher and store, without HTTP.
//!
//! `cargo bench -p benchmark --bench scale`, or `-- WORKERS SECONDS` for one farm. Each worker is a task that exchanges results for leases and sleeps for as long as an
//! evaluation takes, as `worker` does with one thread: it holds what keeps it busy for 1.5 s, at least one evaluation, and renews what
//! it holds. The store is a real file, and an answer waits until it is durable. What HTTP adds is in the bench `throughput`.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use coordinator::service::{FarmSettings, Service};
use shared::api::{NewCalibration, NewExperiment};
use shared::exchange::{ExchangeRequest, PROTOCOL_VERSION, WorkResult};
use shared::outcome::{Observables, Outcome};

type Anyhow<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// Workers, and seconds of an evaluation.
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
/// A worker holds work for so long `[s]`.
const HELD_S: f64 = 1.5;
/// Nothing is counted for so long, while workers begin one after another `[s]`.
const START_S: f64 = 12.0;
/// Then everything for so long `[s]`.
const COUNTED_S: f64 = 15.0;
const LEASE_MS: u64 = 15_000;
const PARTICLES: usize = 50_000;
const CALIBRATIONS: usize = 12;

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
const RUNS: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,30\n";

fn job() -> String {
    format!(
        "accept = [\"data_few\"]\n[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = {{ uniform = [4.0, 5.6] }}\nkappa = 0.0\nn = {{ uniform = [0.8, 1.4] }}\nfriction_angle_deg = {{ uniform = [11.5, 37.3] }}\n[sampler]\nparticles = {PARTICLES}\n"
    )
}

/// What a farm did while it was counted.
#[derive(Default)]
struct Counted {
    is_counting: AtomicU64,
    evaluations: AtomicU64,
    exchanges: AtomicU64,
}

#[tokio::main]
async fn main() -> Anyhow<()> {
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

async fn farm(workers: usize, evaluation_s: f64) -> Anyhow<()> {
    let folder = tempfile::tempdir()?;
    let store = folder.path().join("scale.db");
    let settings = FarmSettings {
        lease_ms: LEASE_MS,
        verified_share: 0.0,
    };
    let service = Service::open(&store.display().to_string(), settings).await?;
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
    let (cpu_s, began) = (cpu_s()?, Instant::now());
    tokio::time::sleep(Duration::from_secs_f64(COUNTED_S)).await;
    counted.is_counting.store(0, Ordering::Relaxed);
    let seconds = began.elapsed().as_secs_f64();
    let cores = (self::cpu_s()? - cpu_s) / seconds;
    let (mut times_ms, mut all) = (Vec::new(), 0_u64);
    for task in tasks {
        let (own_ms, evaluations) = task.await??;
        times_ms.extend(own_ms);
        all += evaluations;
    }
    if times_ms.is_empty() {
        return Err("nothing was counted: the work had run out".into());
    }
    times_ms.sort_by(f32::total_cmp);
    let quantile = |p: f64| times_ms[((times_ms.len() - 1) as f64 * p) as usize];
    let resident_mb = resident_mb()?;
    service.close().await;
    // All calibrations are in progress: every evaluation is replayed.
    let began = Instant::now();
    let service = Service::open(&store.display().to_string(), settings).await?;
    let restart_s = began.elapsed().as_secs_f64();
    println!(
        "{workers:>8} {evaluation_s:>13} {:>12.0} {:>14.0} {:>12.0} {:>8.2} {:>8.1} {cores:>7.2} {resident_mb:>8.0} {:>13.0} {restart_s:>9.1}",
        workers as f64 / evaluation_s,
        counted.evaluations.load(Ordering::Relaxed) as f64 / seconds,
        counted.exchanges.load(Ordering::Relaxed) as f64 / seconds,
        quantile(0.5),
        quantile(0.99),
        (bytes(&store)? - empty_bytes) as f64 / all as f64,
    );
    service.close().await;
    Ok(())
}

/// A worker; the times of the exchanges that were counted `[ms]`, and how many evaluations it did in all.
async fn work(
    service: Service,
    number: usize,
    begins_s: f64,
    evaluation_s: f64,
    ends: Instant,
    counted: Arc<Counted>,
) -> Anyhow<(Vec<f32>, u64)> {
    tokio::time::sleep(Duration::from_secs_f64(begins_s)).await;
    let want = (HELD_S / evaluation_s).max(1.0) as u32;
    let outcome = Outcome::Evaluated(Observables {
        drawbar_pull_n: vec![29.5],
        ..Observables::default()
    });
    let request = |results, holding, want, received| ExchangeRequest {
        worker: format!("scale-{number}"),
        protocol: PROTOCOL_VERSION,
        model_version: "scale".into(),
        models: Default::default(),
        queue_job: None,
        threads: 1,
        evaluation_s: Some(evaluation_s),
        results,
        holding,
        returned: Vec::new(),
        started: Vec::new(),
        received,
        want,
        wait_ms: 30_000,
    };
    let (mut times_ms, mut all, mut received) = (Vec::new(), 0, 0);
    let mut results: Vec<WorkResult> = Vec::new();
    while Instant::now() < ends {
        let done = results.len() as u64;
        let asked = Instant::now();
        let response = service
            .exchange(request(std::mem::take(&mut results), Vec::new(), want, received))
            .await?;
        if counted.is_counting.load(Ordering::Relaxed) == 1 {
            times_ms.push(asked.elapsed().as_secs_f32() * 1e3);
            counted.evaluations.fetch_add(done, Ordering::Relaxed);
            counted.exchanges.fetch_add(1, Ordering::Relaxed);
        }
        all += done;
        received = response.leases.iter().map(|l| l.lease).max().unwrap_or(received);
        // What is held is renewed every third of a lease, as a worker does it.
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
        results = response
            .leases
            .into_iter()
            .map(|lease| WorkResult {
                lease: lease.lease,
                calibration: lease.calibration,
                evaluation: lease.evaluation,
                seal: lease.seal,
                end: None,
                outcome: Some(outcome.clone()),
                repeated: None,
            })
            .collect();
    }
    Ok((times_ms, all))
}

/// CPU time of this process so far `[s]`.
fn cpu_s() -> Anyhow<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    Ok((fields[11].parse::<f64>()? + fields[12].parse::<f64>()?) / 100.0)
}

/// Memory that this process holds `[MB]`.
fn resident_mb() -> Anyhow<f64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kb = line
        .and_then(|line| line.split_whitespace().next())
        .ok_or("no VmRSS")?;
    Ok(kb.parse::<f64>()? / 1000.0)
}

/// Size of the store with its log `[bytes]`.
fn bytes(store: &Path) -> Anyhow<u64> {
    let log = store.with_extension("db-wal");
    Ok(std::fs::metadata(store)?.len() + std::fs::metadata(log).map_or(0, |m| m.len()))
}
