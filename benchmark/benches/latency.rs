//! Times to the answers of a service while samplers with large populations take their steps.
//!
//! `cargo bench -p benchmark --bench latency`, or with `-- CALIBRATIONS PARTICLES SECONDS`. A real `coordinator serve` has several large
//! calibrations in progress, for which workers in this process answer with a model that costs nothing. A probe asks for an exchange,
//! `/health` and `/metrics` all the time. The table is a histogram of the times, by the kind of the request.

use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use benchmark::error::StudyError;
use benchmark::farm_load::{EXPERIMENT, RUNS, job_of, quantile, request, results};
use farm_tests::programs::line;
use reqwest::Client;
use serde_json::{Value, json};
use shared::exchange::ExchangeResponse;
use shared::outcome::{Observables, Outcome};

const WORKERS: usize = 8;
/// The number of results in a message of a worker.
const BATCH: u32 = 64;
/// The time between two probes of a kind.
const PAUSE: Duration = Duration::from_millis(20);
/// The upper bounds of the histogram `[ms]`.
const BOUNDS_MS: [f64; 8] = [5.0, 10.0, 20.0, 50.0, 100.0, 1_000.0, 10_000.0, f64::INFINITY];
const KINDS: [&str; 3] = ["exchange", "/health", "/metrics"];

struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[tokio::main]
async fn main() -> Result<(), StudyError> {
    // A client needs a provider of cryptography even for plain HTTP.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let numbers = std::env::args().filter_map(|word| word.parse().ok());
    let numbers: Vec<usize> = numbers.collect();
    let [calibrations, particles, seconds] = numbers[..] else {
        return measure(8, 50_000, 60).await;
    };
    measure(calibrations, particles, seconds as u64).await
}

async fn measure(calibrations: usize, particles: usize, seconds: u64) -> Result<(), StudyError> {
    let folder = tempfile::tempdir()?;
    let port = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let (address, url) = (format!("127.0.0.1:{port}"), format!("http://127.0.0.1:{port}"));
    let store = format!("sqlite://{}", folder.path().join("bench.db").display());
    let mut serve = line("coordinator serve --listen {} --store {}", &[&address, &store]);
    let _server = Server(serve.stderr(Stdio::null()).spawn()?);
    let client = Client::new();
    while client.get(format!("{url}/health")).send().await.is_err() {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    let new = json!({"toml": EXPERIMENT, "files": {"runs.csv": RUNS}});
    let experiment = post(&client, &url, "experiments", new).await?;
    for _ in 0..calibrations {
        let new = json!({"experiment": experiment["id"], "toml": job_of(particles)});
        post(&client, &url, "calibrations", new).await?;
    }
    let until = Instant::now() + Duration::from_secs(seconds);
    let workers: Vec<_> = (0..WORKERS)
        .map(|number| tokio::spawn(work(Client::new(), url.clone(), number, until)))
        .collect();
    let probes: Vec<_> = (0..KINDS.len())
        .map(|kind| tokio::spawn(probe(Client::new(), url.clone(), kind, until)))
        .collect();
    println!(
        "{calibrations} calibrations of {particles} particles, {seconds} s, {WORKERS} workers at batch {BATCH}\n"
    );
    println!(
        "{:<10} {:>7} {:>8} {:>8} {:>8}  answers within ms",
        "", "answers", "p50 ms", "p99 ms", "max ms"
    );
    for (kind, probe) in KINDS.iter().zip(probes) {
        let mut times_ms = probe.await??;
        times_ms.sort_by(f64::total_cmp);
        let counts = BOUNDS_MS.map(|bound| times_ms.partition_point(|&ms| ms <= bound));
        let within = BOUNDS_MS
            .iter()
            .zip(counts)
            .map(|(bound, count)| format!("{bound}: {count}"));
        println!(
            "{kind:<10} {:>7} {:>8.1} {:>8.1} {:>8.1}  {}",
            times_ms.len(),
            quantile(&times_ms, 0.5),
            quantile(&times_ms, 0.99),
            times_ms[times_ms.len() - 1],
            within.collect::<Vec<_>>().join("  ")
        );
    }
    let mut evaluations = 0;
    for worker in workers {
        evaluations += worker.await??;
    }
    println!(
        "\n{evaluations} evaluations, {:.1} rounds of all calibrations",
        evaluations as f64 / (calibrations * particles) as f64
    );
    Ok(())
}

async fn post(client: &Client, url: &str, what: &str, body: Value) -> Result<Value, StudyError> {
    let response = client.post(format!("{url}/v1/{what}")).json(&body).send().await?;
    Ok(response.error_for_status()?.json().await?)
}

/// Asks for the answers of a kind until a time; returns how long each took `[ms]`.
async fn probe(client: Client, url: String, kind: usize, until: Instant) -> Result<Vec<f64>, StudyError> {
    let mut times_ms = Vec::new();
    while Instant::now() < until {
        let asked = match kind {
            // It takes no lease, so that no evaluation waits for a worker that does not compute.
            0 => {
                let question = request("probe".into(), Vec::new(), 0, 0, 0);
                client.post(format!("{url}/v1/work/exchange")).json(&question)
            }
            _ => client.get(format!("{url}{}", KINDS[kind])),
        };
        let sent = Instant::now();
        asked.send().await?.error_for_status()?.bytes().await?;
        times_ms.push(sent.elapsed().as_secs_f64() * 1e3);
        tokio::time::sleep(PAUSE).await;
    }
    Ok(times_ms)
}

/// Plays a worker whose model is a curve of the first parameter; returns the number of its evaluations.
async fn work(client: Client, url: String, number: usize, until: Instant) -> Result<usize, StudyError> {
    let (mut done, mut received, mut evaluations) = (Vec::new(), 0, 0);
    while Instant::now() < until {
        evaluations += done.len();
        let message = request(
            format!("bench-{number}"),
            std::mem::take(&mut done),
            received,
            BATCH,
            1000,
        );
        let response = client
            .post(format!("{url}/v1/work/exchange"))
            .json(&message)
            .send()
            .await?;
        let response: ExchangeResponse = response.error_for_status()?.json().await?;
        received = response.leases.iter().map(|l| l.lease).max().unwrap_or(received);
        for lease in response.leases {
            let outcome = outcome(lease.theta[0]);
            done.extend(results(vec![lease], &outcome));
        }
    }
    Ok(evaluations)
}

fn outcome(theta: f64) -> Outcome {
    Outcome::Evaluated(Observables {
        drawbar_pull_n: vec![10.0 + 4.0 * theta],
        torque_n_m: vec![5.0],
        sinkage_m: vec![0.005],
        lateral_force_n: vec![0.0],
        b_eff_m: vec![0.03],
        contact_length_m: vec![0.04],
        residual_load_n: vec![0.0],
        nodes_in_contact: vec![16],
        simulated_travel_m: vec![0.0],
        ..Observables::default()
    })
}
