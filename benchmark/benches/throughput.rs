//! Leased and durably completed evaluations per second, through real HTTP, with a model that costs nothing.
//!
//! `cargo bench -p benchmark --bench throughput`; with `-- postgres://USER@HOST:PORT` in a database of that server, which is made anew.
//! A real `coordinator serve` on a real store; 32 connected workers in this process, each of which exchanges the results of its last
//! batch for the next one; with and without verification on a second worker, by turns. At the end a swarm of a thousand workers.

use std::error::Error;
use std::path::Path;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use farm_tests::programs::coordinator;
use reqwest::Client;
use serde_json::{Value, json};
use shared::exchange::{ExchangeRequest, ExchangeResponse, PROTOCOL_VERSION, WorkResult};
use shared::outcome::{Observables, Outcome};
use sqlx::{Connection, Executor, PgConnection};

type Anyhow<T> = Result<T, Box<dyn Error + Send + Sync>>;

const WORKERS: usize = 32;
const SWARM: usize = 1_000;
const SECONDS: u64 = 8;
/// The first round alone lasts longer than the measurement, so that no sampler's step is measured.
const PARTICLES: usize = 50_000;
/// Several calibrations at once, so that the work does not run out and none waits for another's sampler.
const CALIBRATIONS: usize = 16;

/// (batch, goal in evaluations per second) on two cores that the workers share.
const BATCHES: [(u32, f64); 3] = [(1, 2_000.0), (16, 20_000.0), (64, 20_000.0)];
const GOAL_P99_MS: f64 = 50.0;
const GOAL_CPU_US: f64 = 40.0;
const GOAL_SWARM_CPU_US: f64 = 60.0;
const GOAL_SWARM_MB: f64 = 150.0;
/// Verification costs at most so much of the throughput at batch 16 `[%]`.
const GOAL_VERIFICATION_PERCENT: f64 = 5.0;
/// Shares of the evaluations that are verified `[%]`: none, and the default.
const VERIFIED_PERCENT: [&str; 2] = ["0", "1"];
/// So often each is measured, by turns.
const TURNS: usize = 3;

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
const RUNS: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,30\n";

fn job() -> String {
    format!(
        "accept = [\"data_few\"]\n[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = {{ uniform = [4.0, 5.6] }}\nkappa = 0.0\nn = {{ uniform = [0.8, 1.4] }}\nfriction_angle_deg = {{ uniform = [11.5, 37.3] }}\n[sampler]\nparticles = {PARTICLES}\n"
    )
}

struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Server {
    /// CPU time of the process so far `[s]`.
    fn cpu_s(&self) -> Anyhow<f64> {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.0.id()))?;
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
        let ticks: f64 = fields[11].parse::<f64>()? + fields[12].parse::<f64>()?;
        Ok(ticks / 100.0)
    }

    /// Most memory that the process has held so far `[MB]`.
    fn max_resident_mb(&self) -> Anyhow<f64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.0.id()))?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kb = line
            .and_then(|line| line.split_whitespace().next())
            .ok_or("no VmHWM")?;
        Ok(kb.parse::<f64>()? / 1000.0)
    }
}

#[tokio::main]
async fn main() -> Anyhow<()> {
    // A client names its cryptography even where it speaks plain HTTP.
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
        "{SWARM} workers at batch 16: {:.0} evaluations/s, p99 {:.0} ms, {:.1} us of the coordinator (at most {GOAL_SWARM_CPU_US}), {:.0} MB (at most {GOAL_SWARM_MB})",
        m.per_second, m.p99_ms, m.cpu_us, m.resident_mb
    );
    Ok(())
}

struct Measured {
    per_second: f64,
    p50_ms: f64,
    p99_ms: f64,
    cpu_us: f64,
    /// Most memory that the coordinator held.
    resident_mb: f64,
}

/// Where stores are: files, or databases of a server.
struct Place(Option<String>);

impl Place {
    fn name(&self) -> &str {
        self.0.as_deref().unwrap_or("a file")
    }

    /// An empty store.
    async fn store(&self, folder: &Path) -> Anyhow<String> {
        let Some(server) = &self.0 else {
            return Ok(format!("sqlite://{}", folder.join("bench.db").display()));
        };
        let mut connection = PgConnection::connect(&format!("{server}/postgres")).await?;
        connection
            .execute("DROP DATABASE IF EXISTS grouser_bench WITH (FORCE)")
            .await?;
        connection.execute("CREATE DATABASE grouser_bench").await?;
        Ok(format!("{server}/grouser_bench"))
    }
}

async fn measure(place: &Place, connected: usize, batch: u32, verify_percent: &str) -> Anyhow<Measured> {
    let folder = tempfile::tempdir()?;
    let port = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let url = format!("http://127.0.0.1:{port}");
    let store = place.store(folder.path()).await?;
    let server = Server(
        coordinator([
            "serve",
            "--listen",
            &format!("127.0.0.1:{port}"),
            "--store",
            &store,
            "--verify-percent",
            verify_percent,
        ])
        .stderr(Stdio::null())
        .spawn()?,
    );
    let client = Client::new();
    while client.get(format!("{url}/health")).send().await.is_err() {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    let experiment = post(
        &client,
        &url,
        "experiments",
        json!({"toml": EXPERIMENT, "files": {"runs.csv": RUNS}}),
    )
    .await?;
    for _ in 0..CALIBRATIONS {
        post(
            &client,
            &url,
            "calibrations",
            json!({"experiment": experiment["id"], "toml": job()}),
        )
        .await?;
    }

    let completed = Arc::new(AtomicU64::new(0));
    let cpu_before = server.cpu_s()?;
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
    let quantile = |p: f64| latencies_ms[((latencies_ms.len() - 1) as f64 * p) as usize];
    Ok(Measured {
        per_second: evaluations / seconds,
        p50_ms: quantile(0.5),
        p99_ms: quantile(0.99),
        cpu_us: 1e6 * (server.cpu_s()? - cpu_before) / evaluations,
        resident_mb: server.max_resident_mb()?,
    })
}

async fn post(client: &Client, url: &str, what: &str, body: Value) -> Anyhow<Value> {
    let response = client.post(format!("{url}/v1/{what}")).json(&body).send().await?;
    Ok(response.error_for_status()?.json().await?)
}

/// A worker whose model costs nothing; the times of its exchanges `[ms]`.
async fn work(
    client: Client,
    url: String,
    number: usize,
    batch: u32,
    until: Instant,
    completed: Arc<AtomicU64>,
) -> Anyhow<Vec<f64>> {
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
    let (mut results, mut received): (Vec<WorkResult>, u64) = (Vec::new(), 0);
    let mut latencies_ms = Vec::new();
    while Instant::now() < until {
        let done = results.len() as u64;
        let request = ExchangeRequest {
            worker: format!("bench-{number}"),
            protocol: PROTOCOL_VERSION,
            model_version: "bench".into(),
            models: Default::default(),
            queue_job: None,
            threads: 1,
            evaluation_s: None,
            results: std::mem::take(&mut results),
            holding: Vec::new(),
            returned: Vec::new(),
            started: Vec::new(),
            received,
            want: batch,
            wait_ms: 1000,
        };
        let sent = Instant::now();
        let response = client
            .post(format!("{url}/v1/work/exchange"))
            .json(&request)
            .send()
            .await?;
        let response: ExchangeResponse = response.error_for_status()?.json().await?;
        latencies_ms.push(sent.elapsed().as_secs_f64() * 1e3);
        completed.fetch_add(done, Ordering::Relaxed);
        received = response.leases.iter().map(|l| l.lease).max().unwrap_or(received);
        results = response
            .leases
            .into_iter()
            .map(|l| WorkResult {
                lease: l.lease,
                calibration: l.calibration,
                evaluation: l.evaluation,
                seal: l.seal,
                end: None,
                outcome: Some(outcome.clone()),
                repeated: None,
            })
            .collect();
    }
    Ok(latencies_ms)
}
