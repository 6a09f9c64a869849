//! External models: programs and UM-Bridge servers.

mod answers;
mod bits;
mod served;
mod version;

use farm_tests::job::Job;
use farm_tests::umbridge_server::{Question, Reply, UmbridgeServer};

/// Runs of [`job`].
const RUNS: u64 = 6;

/// Returns a job of the model `wheel` at a URL: two parameters, six runs.
fn job(url: &str) -> Job {
    Job {
        experiment: "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.1\n[soil.s]\n[noise]\n\
            drawbar_pull_n = 1.0\ntorque_n_m = 0.1\nsinkage_m = 0.001\n"
            .into(),
        runs: measured(),
        job: format!(
            "experiment = \"experiment.toml\"\n[model]\nkind = \"umbridge\"\nurl = \"{url}\"\nmodel = \"wheel\"\n{LAYOUT}"
        ),
        attached: Vec::new(),
    }
}

/// Returns a job with the model as a program, `wheel.py`.
fn program_job() -> Job {
    let job = job("http://x");
    job.in_job(
        "kind = \"umbridge\"\nurl = \"http://x\"\nmodel = \"wheel\"",
        "kind = \"command\"\nprogram = \"wheel.py\"",
    )
}

/// Returns a job with fewer draws: a program takes some tens of milliseconds to start.
fn short(job: Job) -> Job {
    job.in_job("particles = 60", "particles = 20")
        .in_job("moves = [2, 4]", "moves = [1, 2]")
}

const LAYOUT: &str = r#"version = "1"
inputs = ["slip", "wheel_load_n"]
parameters = ["grip [1]", "softness [m/N]"]
outputs = ["drawbar_pull_n", "torque_n_m", "sinkage_m"]
time_s = 20

[priors]
grip = { uniform = [0.2, 1.0] }
softness = { uniform = [1e-5, 4e-4] }

[sampler]
algorithm = "tmcmc"
particles = 60
moves = [2, 4]
seed = 1
"#;

/// The model: simple sums and products, so that every language computes the same bits.
fn wheel(run: &[f64], parameters: &[f64]) -> [f64; 3] {
    let (slip, load, grip, softness) = (run[0], run[1], parameters[0], parameters[1]);
    let thrust = grip * load * slip / (slip + 0.125);
    [thrust - 2.0, thrust * 0.125, softness * load]
}

/// Returns the model as a program, with code that runs before it answers.
fn program(before: &str) -> String {
    format!(
        "#!/usr/bin/env python3\nimport json, os, sys, time\n\
         def wheel(slip, wheel_load_n, grip, softness):\n    \
             thrust = grip * wheel_load_n * slip / (slip + 0.125)\n    \
             return {{\"drawbar_pull_n\": thrust - 2.0, \"torque_n_m\": thrust * 0.125, \"sinkage_m\": softness * wheel_load_n}}\n\
         runs = json.load(sys.stdin)[\"runs\"]\n{before}\n\
         json.dump({{\"runs\": [wheel(**run) for run in runs]}}, sys.stdout)\n"
    )
}

/// Returns a server that answers as the model says.
fn honest() -> UmbridgeServer {
    UmbridgeServer::start(answer)
}

fn answer(question: &Question) -> Reply {
    Reply::channels(wheel(&question.run, &question.parameters))
}

/// Returns the measurements: the model at grip 0.6 and softness 1e-4, a little off.
fn measured() -> String {
    let mut rows = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,pass,drawbar_pull_n,torque_n_m,sinkage_m,use\n".to_owned();
    for (i, (slip, load)) in [
        (0.1, 60.0),
        (0.1, 120.0),
        (0.25, 60.0),
        (0.25, 120.0),
        (0.5, 60.0),
        (0.5, 120.0),
    ]
    .into_iter()
    .enumerate()
    {
        let [pull, torque, sinkage] = wheel(&[slip, load], &[0.6, 1e-4]);
        let off = [0.5, -0.75, 0.25][i % 3];
        let (pull, torque, sinkage) = (pull + off, torque - 0.1 * off, sinkage + 0.001 * off);
        rows += &format!("r{i},w,s,{slip},{load},0.01,0,1,{pull},{torque},{sinkage},fit\n");
    }
    rows
}

/// Writes a program that can be started.
fn write_program(folder: &std::path::Path, text: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join("wheel.py");
    // The file is replaced by a rename, because a file that is being executed cannot be written.
    let new = folder.join("wheel.py.new");
    std::fs::write(&new, text).expect("a program");
    std::fs::set_permissions(&new, std::fs::Permissions::from_mode(0o755)).expect("a program");
    std::fs::rename(&new, &path).expect("a program");
    path.display().to_string()
}
