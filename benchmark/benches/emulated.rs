//! Evaluations and errors of emulated sampling on jobs.
//!
//! `cargo bench -p benchmark --bench emulated -- SEEDS JOB...` samples the job of each file with seeds 1 to SEEDS, or FIRST-LAST, each on one
//! thread, and prints a line: the seeds whose emulator was given up; of the other seeds mean and largest number of evaluations before the final
//! draws and of all; mean and sd of ln Z over the seeds, and the mean standard error that was reported; the mean effective number of the final
//! draws; and the seconds that the model and the sampler itself took. `cargo bench -p inference --bench sampler_table -- emulated` does the
//! same for problems with known evidence.

#![expect(clippy::unwrap_used, reason = "a study may panic as tests do")]

use std::path::Path;
use std::time::{Duration, Instant};

use benchmark::error::StudyError;
use benchmark::parallel::each;
use coordinator::embedded::Evaluate;
use inference::EmulatedSampler;
use job::{AlgorithmSettings, Spec};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::outcome::Outcome;

/// What one seed found.
struct Sampled {
    /// `None`: the emulator was given up.
    posterior: Option<SampledPosterior>,
    model_time: Duration,
    time: Duration,
}

struct SampledPosterior {
    to_exponent_1: f64,
    evaluations: f64,
    log_evidence: f64,
    se: f64,
    ess: f64,
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

fn sample(spec: &Spec, model: &Evaluate, seed: u64) -> Sampled {
    let AlgorithmSettings::Sample(mut settings) = spec.algorithm else {
        panic!("the job has no sampler");
    };
    settings.seed = seed;
    let began = Instant::now();
    let mut model_time = Duration::ZERO;
    let (likelihood, parameters) = (spec.likelihood.clone(), spec.fit_variant.parameters.len());
    let mut sampler = EmulatedSampler::new(spec.prior(), likelihood, settings, parameters).unwrap();
    while !sampler.round().pending().is_empty() && !sampler.record().fell_back {
        for proposal in sampler.round().pending().to_vec() {
            let asked = Instant::now();
            let outcome = model.evaluate(spec.model_theta(&proposal.theta));
            model_time += asked.elapsed();
            let values = match &outcome {
                Outcome::Evaluated(observables) => Some(spec.predicted_values(observables)),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            };
            sampler.tell(proposal.particle, values.as_deref()).unwrap();
        }
    }
    let finals = &sampler.record().finals;
    let final_draws: usize = finals.iter().map(|weights| weights.draws).sum();
    let posterior = sampler.posterior().map(|posterior| SampledPosterior {
        to_exponent_1: posterior.evaluations as f64 - final_draws as f64,
        evaluations: posterior.evaluations as f64,
        log_evidence: posterior.log_evidence,
        se: posterior.log_evidence_se,
        ess: finals.last().unwrap().ess,
    });
    Sampled {
        posterior,
        model_time,
        time: began.elapsed(),
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let (first, last) = arguments[0].split_once('-').unwrap_or(("1", &arguments[0]));
    let first: u64 = first.parse().unwrap();
    let seeds = last.parse::<u64>().unwrap() + 1 - first;
    for path in &arguments[1..] {
        let spec = read(Path::new(path));
        let model = Evaluate::new(&spec.sampled_variant()).unwrap();
        let sampled: Vec<Sampled> = each(seeds, |seed| {
            Ok::<_, StudyError>(sample(&spec, &model, first + seed))
        })
        .unwrap();
        let posteriors: Vec<&SampledPosterior> =
            sampled.iter().filter_map(|s| s.posterior.as_ref()).collect();
        let values = |value: fn(&SampledPosterior) -> f64| -> Vec<f64> {
            posteriors.iter().map(|p| value(p)).collect()
        };
        let mean =
            |value: fn(&SampledPosterior) -> f64| values(value).iter().sum::<f64>() / posteriors.len() as f64;
        let max = |value: fn(&SampledPosterior) -> f64| values(value).into_iter().fold(0.0, f64::max);
        let seconds = |time: fn(&Sampled) -> Duration| {
            sampled.iter().map(time).sum::<Duration>().as_secs_f64() / seeds as f64
        };
        let (log_evidence, sd) =
            inference::diagnostics::mean_and_sd(&values(|p| p.log_evidence)).unwrap_or((f64::NAN, f64::NAN));
        println!(
            "{path}: {} parameters, {} outputs; given up {} of {seeds}; evaluations to exponent 1 {:.0} (max {:.0}), all {:.0} (max {:.0}); ln Z \
             {log_evidence:.4} with sd {sd:.4} and se {:.4}; {:.0} effective draws; seconds a seed: model {:.2}, sampler {:.2}",
            spec.prior().dimension(),
            spec.likelihood.values(),
            sampled.len() - posteriors.len(),
            mean(|p| p.to_exponent_1),
            max(|p| p.to_exponent_1),
            mean(|p| p.evaluations),
            max(|p| p.evaluations),
            mean(|p| p.se),
            mean(|p| p.ess),
            seconds(|s| s.model_time),
            seconds(|s| s.time - s.model_time),
        );
    }
}
