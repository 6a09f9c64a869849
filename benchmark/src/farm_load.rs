//! The work of a farm whose model costs nothing: the submitted jobs, and the messages of its workers.

use shared::exchange::{ExchangeRequest, Lease, PROTOCOL_VERSION, WorkResult};
use shared::outcome::Outcome;

/// An experiment with one run.
pub const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
/// `runs.csv` of the experiment.
pub const RUNS: &str =
    "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,30\n";
/// The number of particles. The first round alone lasts longer than a measurement, so that no step of the sampler is measured.
const PARTICLES: usize = 50_000;

/// Returns the text of the job.
pub fn job() -> String {
    job_of(PARTICLES)
}

/// Returns the text of a job with a number of particles.
pub fn job_of(particles: usize) -> String {
    format!(
        "accept = [\"data_few\"]\n[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = {{ uniform = [4.0, 5.6] }}\nkappa = 0.0\nn = {{ uniform = [0.8, 1.4] }}\nfriction_angle_deg = {{ uniform = [11.5, 37.3] }}\n[sampler]\nparticles = {particles}\n"
    )
}

/// Returns a request of a worker for a number of leases, which it waits for.
pub fn request(
    worker: String,
    results: Vec<WorkResult>,
    received: u64,
    want: u32,
    wait_ms: u64,
) -> ExchangeRequest {
    ExchangeRequest {
        worker,
        protocol: PROTOCOL_VERSION,
        model_version: "benchmark".into(),
        models: Default::default(),
        queue_job: None,
        threads: 1,
        evaluation_s: None,
        results,
        holding: Vec::new(),
        returned: Vec::new(),
        started: Vec::new(),
        received,
        want,
        wait_ms,
    }
}

/// Answers every lease with the same outcome.
pub fn results(leases: Vec<Lease>, outcome: &Outcome) -> Vec<WorkResult> {
    let result = |lease: Lease| WorkResult {
        lease: lease.lease,
        calibration: lease.calibration,
        evaluation: lease.evaluation,
        seal: lease.seal,
        outcome: outcome.clone(),
        repeated: None,
    };
    leases.into_iter().map(result).collect()
}

/// Returns a quantile of sorted values.
pub fn quantile<T: Copy>(sorted: &[T], p: f64) -> T {
    sorted[((sorted.len() - 1) as f64 * p) as usize]
}
