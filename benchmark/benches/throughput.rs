//! Leased and durably completed evaluations per second, through real HTTP, with a model that costs nothing.
//!
//! `cargo bench -p benchmark --bench throughput`, or with `-- postgres://USER@HOST:PORT` in a database of that server, which is created
//! anew. A real `coordinator serve` runs on a real store. Each of 32 connected workers in this process exchanges the results of its last
//! batch for the next one. Turns with verification by a second worker alternate with turns without it. The last farm has a thousand
//! workers.

use std::path::Path;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use benchmark::error::StudyError;
use benchmark::farm_load::{EXPERIMENT, RUNS, job, quantile, request, results};
use benchmark::process::{cpu_s, memory_kb};
use farm_tests::programs::line;
use reqwest::Client;
use serde_json::{Value, json};
use shared::exchange::{ExchangeResponse, WorkResult};
use shared::outcome::{Observables, Outcome};
use sqlx::{Connection, Executor, PgConnection};

const WORKERS: usize = 32;
const SWARM: usize = 1_000;
const SECONDS: u64 = 8;
/// The number of calibrations, so that the work does not run out while a sampler computes its next step.
const CALIBRATIONS: usize = 16;

/// Each batch with its goal in evaluations per second, on two cores that coordinator and workers share.
const BATCHES: [(u32, f64); 3] = [(1, 2_000.0), (16, 20_000.0), (64, 20_000.0)];
const GOAL_P99_MS: f64 = 50.0;
const GOAL_CPU_US: f64 = 40.0;
const GOAL_SWARM_CPU_US: f64 = 60.0;
const GOAL_SWARM_MB: f64 = 150.0;
/// The largest share of the throughput at batch 16 that verification costs `[%]`.
const GOAL_VERIFICATION_PERCENT: f64 = 5.0;
/// Shares of the evaluations that are verified `[%]`: none, and the default.
const VERIFIED_PERCENT: [&str; 2] = ["0", "1"];
/// The number of alternating turns of each.
const TURNS: usize = 3;

struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Server {
    fn id(&self) -> String {
        self.0.id().to_string()
    }
}

#[tokio::main]
async fn main() -> Result<(), StudyError> {
    // A client needs a provider of cryptography even for plain HTTP.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let place = Place(std::env::args().find(|word| word.starts_with("postgres")));
    println!(
        "{WORKERS} workers, {SECONDS} s each, durable before the answer, in {}\n",
        place.name()
    );
    println!(
        "{:>6} {:>14} {:>9} {:>8} {:>8} {:>8} {:>16}",
        "batch", "evaluations/s", "goal", "p50 ms", "p99 ms", "goal", "coordinator us"
    );
    for (batch, goal) in BATCHES {
        let m = measure(&place, WORKERS, batch, "1").await?;
        println!(
            "{batch:>6} {:>14.0} {goal:>9.0} {:>8.2} {:>8.2} {GOAL_P99_MS:>8.0} {:>8.1} of {GOAL_CPU_US:.0}",
            m.per_second, m.p50_ms, m.p99_ms, m.cpu_us
        );
    }
    let mut rates = [0.0; 2];
    for _ in 0..TURNS {
        for (rate, percent) in rates.iter_mut().zip(VERIFIED_PERCENT) {
            *rate += measure(&place, WORKERS, 16, percent).await?.per_second / TURNS as f64;
        }
    }
    println!(
        "\nverification of 1 % at batch 16: {:.0} evaluations/s, without {:.0}: {:.1} % less (at most {GOAL_VERIFICATION_PERCENT} %)",
        rates[1],
        rates[0],
        100.0 * (1.0 - rates[1] / rates[0])
    );
    let m = measure(&place, SWARM, 16, "1").await?;
    println!(
        "{SWARM} workers at batch 16: {:.0} evaluations/s, p99 {:.0} ms, {:.1} us of the coordinator (at most {GOAL_SWARM_CPU_US}), {:.0} MB for the workers (at most {GOAL_SWARM_MB}), {:.0} MB for the jobs",
        m.per_second,
        m.p99_ms,
        m.cpu_us,
        m.resident_mb - m.jobs_mb,
        m.jobs_mb
    );
    Ok(())
}

struct Measured {
    per_second: f64,
    p50_ms: f64,
    p99_ms: f64,
    cpu_us: f64,
    /// The memory of the coordinator with its jobs, before a worker comes.
    jobs_mb: f64,
    /// The largest memory of the coordinator.
    resident_mb: f64,
}

/// The place of the stores: files, or databases of a server.
struct Place(Option<String>);

impl Place {
    fn name(&self) -> &str {
        self.0.as_deref().unwrap_or("a file")
    }

    /// Returns an empty store.
    async fn store(&self, folder: &Path) -> Result<String, StudyError> {
        let Some(server) = &self.0 else {
            return Ok(format!("sqlite://{}", folder.join("bench.db").display()));
        };
        let mut connection = PgConnection::connect(&format!("{server}/postgres")).await?;
        let drop = "DROP DATABASE IF EXISTS grouser_bench WITH (FORCE)";
        connection.execute(drop).await?;
        connection.execute("CREATE DATABASE grouser_bench").await?;
        Ok(format!("{server}/grouser_bench"))
    }
}

async fn measure(
    place: &Place,
    connected: usize,
    batch: u32,
    verify_percent: &str,
) -> Result<Measured, StudyError> {
    let folder = tempfile::tempdir()?;
    let port = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let address = format!("127.0.0.1:{port}");
    let url = format!("http://{address}");
    let store = place.store(folder.path()).await?;
    let words = "coordinator serve --listen {} --store {} --verify-percent {}";
    let mut serve = line(words, &[&address, &store, &verify_percent]);
    let server = Server(serve.stderr(Stdio::null()).spawn()?);
    let client = Client::new();
    while client.get(format!("{url}/health")).send().await.is_err() {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    let new = json!({"toml": EXPERIMENT, "files": {"runs.csv": RUNS}});
    let experiment = post(&client, &url, "experiments", new).await?;
    for _ in 0..CALIBRATIONS {
        let new = json!({"experiment": experiment["id"], "toml": job()});
        post(&client, &url, "calibrations", new).await?;
    }

    let memory_mb = |key| memory_kb(&server.id(), key).map(|kb| kb as f64 / 1000.0);
    let jobs_mb = memory_mb("VmRSS")?;
    let completed = Arc::new(AtomicU64::new(0));
    let cpu_before = cpu_s(&server.id())?;
    let began = Instant::now();
    let until = began + Duration::from_secs(SECONDS);
    let workers: Vec<_> = (0..connected)
        .map(|k| {
            tokio::spawn(work(
                Client::new(),
                url.clone(),
                k,
                batch,
                until,
                completed.clone(),
            ))
        })
        .collect();
    let mut latencies_ms = Vec::new();
    for worker in workers {
        latencies_ms.extend(worker.await??);
    }
    if connected <= WORKERS && latencies_ms.iter().any(|&ms| ms > 900.0) {
        return Err("a worker waited for work: the figures would be of an idle farm".into());
    }
    let seconds = began.elapsed().as_secs_f64();
    let evaluations = completed.load(Ordering::Relaxed) as f64;
    latencies_ms.sort_by(f64::total_cmp);
    Ok(Measured {
        per_second: evaluations / seconds,
        p50_ms: quantile(&latencies_ms, 0.5),
        p99_ms: quantile(&latencies_ms, 0.99),
        cpu_us: 1e6 * (cpu_s(&server.id())? - cpu_before) / evaluations,
        jobs_mb,
        resident_mb: memory_mb("VmHWM")?,
    })
}

async fn post(client: &Client, url: &str, what: &str, body: Value) -> Result<Value, StudyError> {
    let response = client.post(format!("{url}/v1/{what}")).json(&body).send().await?;
    Ok(response.error_for_status()?.json().await?)
}

/// Plays a worker whose model costs nothing; returns the times of its exchanges `[ms]`.
async fn work(
    client: Client,
    url: String,
    number: usize,
    batch: u32,
    until: Instant,
    completed: Arc<AtomicU64>,
) -> Result<Vec<f64>, StudyError> {
    let outcome = Outcome::Evaluated(Observables {
        drawbar_pull_n: vec![29.5],
        torque_n_m: vec![5.0],
        sinkage_m: vec![0.005],
        lateral_force_n: vec![0.0],
        b_eff_m: vec![0.03],
        contact_length_m: vec![0.04],
        residual_load_n: vec![0.0],
        nodes_in_contact: vec![16],
        simulated_travel_m: vec![0.0],
        ..Observables::default()
    });
    let (mut done, mut received): (Vec<WorkResult>, u64) = (Vec::new(), 0);
    let mut latencies_ms = Vec::new();
    while Instant::now() < until {
        let count = done.len() as u64;
        let message = request(
            format!("bench-{number}"),
            std::mem::take(&mut done),
            received,
            batch,
            1000,
        );
        let sent = Instant::now();
        let response = client
            .post(format!("{url}/v1/work/exchange"))
            .json(&message)
            .send()
            .await?;
        let response: ExchangeResponse = response.error_for_status()?.json().await?;
        latencies_ms.push(sent.elapsed().as_secs_f64() * 1e3);
        completed.fetch_add(count, Ordering::Relaxed);
        received = response.leases.iter().map(|l| l.lease).max().unwrap_or(received);
        done = results(response.leases, &outcome);
    }
    Ok(latencies_ms)
}
