//! Evaluations and errors of emulated sampling on jobs.
//!
//! `cargo bench -p benchmark --bench emulated -- SEEDS JOB...` samples the job of each file with seeds 1 to SEEDS, in one process and on one
//! thread, and prints a line: the seeds whose emulator was given up; of the other seeds mean and largest number of evaluations before the final
//! draws and of all; mean and sd of ln Z over the seeds, and the mean standard error that was reported; the mean effective number of the final
//! draws; and the seconds that the model and the sampler itself took. `cargo bench -p inference --bench sampler_table -- emulated` does the
//! same for problems with known evidence.

#![expect(clippy::unwrap_used, reason = "a study may panic as tests do")]

use std::path::Path;
use std::time::{Duration, Instant};

use coordinator::embedded::Evaluate;
use inference::EmulatedSampler;
use job::{AlgorithmSettings, Spec};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::outcome::Outcome;

/// What the seeds of a job found.
#[derive(Default)]
struct Row {
    given_up: usize,
    to_exponent_1: Vec<f64>,
    evaluations: Vec<f64>,
    log_evidences: Vec<f64>,
    ses: Vec<f64>,
    ess: Vec<f64>,
    model_time: Duration,
    time: Duration,
}

/// Reads a job, its experiment, and the CSV files that it names beside itself.
fn read(path: &Path) -> Spec {
    let toml = std::fs::read_to_string(path).unwrap();
    let line = toml.lines().find(|line| line.starts_with("experiment")).unwrap();
    let experiment = path.with_file_name(line.split('"').nth(1).unwrap());
    let mut job = FileSet {
        toml,
        ..FileSet::default()
    };
    for entry in std::fs::read_dir(path.parent().unwrap()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".csv") && job.toml.contains(&format!("\"{name}\"")) {
            let text = std::fs::read_to_string(path.with_file_name(&name)).unwrap();
            job.files.insert(name, text);
        }
    }
    let experiment = Experiment::read_files(&experiment).unwrap();
    Spec::new("job.toml", &job, "experiment.toml", &experiment).unwrap()
}

fn sample(spec: &Spec, model: &Evaluate, seed: u64, row: &mut Row) {
    let AlgorithmSettings::Sample(mut settings) = spec.algorithm else {
        panic!("the job has no sampler");
    };
    settings.seed = seed;
    let began = Instant::now();
    let (likelihood, parameters) = (spec.likelihood.clone(), spec.fit_variant.parameters.len());
    let mut sampler = EmulatedSampler::new(spec.prior(), likelihood, settings, parameters).unwrap();
    while !sampler.round().pending().is_empty() && !sampler.record().fell_back {
        for proposal in sampler.round().pending().to_vec() {
            let asked = Instant::now();
            let outcome = model.evaluate(spec.model_theta(&proposal.theta));
            row.model_time += asked.elapsed();
            let values = match &outcome {
                Outcome::Evaluated(observables) => Some(spec.predicted_values(observables)),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            };
            sampler.tell(proposal.particle, values.as_deref()).unwrap();
        }
    }
    row.time += began.elapsed();
    let Some(posterior) = sampler.posterior() else {
        row.given_up += 1;
        return;
    };
    let finals = &sampler.record().finals;
    let final_draws: usize = finals.iter().map(|weights| weights.draws).sum();
    row.to_exponent_1
        .push(posterior.evaluations as f64 - final_draws as f64);
    row.evaluations.push(posterior.evaluations as f64);
    row.log_evidences.push(posterior.log_evidence);
    row.ses.push(posterior.log_evidence_se);
    row.ess.push(finals.last().unwrap().ess);
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let seeds: u64 = arguments[0].parse().unwrap();
    for path in &arguments[1..] {
        let spec = read(Path::new(path));
        let model = Evaluate::new(&spec.sampled_variant()).unwrap();
        let mut row = Row::default();
        for seed in 1..=seeds {
            sample(&spec, &model, seed, &mut row);
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let max = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let (log_evidence, sd) =
            inference::diagnostics::mean_and_sd(&row.log_evidences).unwrap_or((f64::NAN, f64::NAN));
        println!(
            "{path}: {} parameters, {} outputs; given up {} of {seeds}; evaluations to exponent 1 {:.0} (max {:.0}), all {:.0} (max {:.0}); ln Z \
             {log_evidence:.4} with sd {sd:.4} and se {:.4}; {:.0} effective draws; seconds a seed: model {:.2}, sampler {:.2}",
            spec.prior().dimension(),
            spec.likelihood.values(),
            row.given_up,
            mean(&row.to_exponent_1),
            max(&row.to_exponent_1),
            mean(&row.evaluations),
            max(&row.evaluations),
            mean(&row.ses),
            mean(&row.ess),
            row.model_time.as_secs_f64() / seeds as f64,
            (row.time - row.model_time).as_secs_f64() / seeds as f64,
        );
    }
}
