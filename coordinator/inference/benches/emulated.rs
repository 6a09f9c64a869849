//! The table of emulated sampling: its evaluations and errors on problems with known evidence.

use inference::{EmulatedSampler, TmcmcSettings};

use crate::output_problems::{self, OutputProblem};

/// What the seeds of a problem found.
#[derive(Default)]
struct Row {
    fallbacks: usize,
    to_exponent_1: Vec<f64>,
    evaluations: Vec<f64>,
    errors: Vec<f64>,
    ses: Vec<f64>,
    ess: Vec<f64>,
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn root_mean_square(values: &[f64]) -> f64 {
    mean(&values.iter().map(|x| x * x).collect::<Vec<_>>()).sqrt()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

fn row(problem: &OutputProblem, seeds: u64) -> Row {
    let mut row = Row::default();
    for seed in 1..=seeds {
        let settings = TmcmcSettings {
            seed,
            ..TmcmcSettings::default()
        };
        let (prior, likelihood) = (problem.prior.clone(), problem.likelihood.clone());
        let mut sampler =
            EmulatedSampler::new(prior, likelihood, settings, problem.model_parameters).unwrap();
        while !sampler.round().pending().is_empty() && !sampler.record().fell_back {
            for proposal in sampler.round().pending().to_vec() {
                let outputs = (problem.outputs)(&proposal.theta);
                sampler.tell(proposal.particle, outputs.as_deref()).unwrap();
            }
        }
        let record = sampler.record();
        let Some(posterior) = sampler.posterior() else {
            row.fallbacks += 1;
            continue;
        };
        let finals: usize = record.finals.iter().map(|weights| weights.draws).sum();
        row.to_exponent_1
            .push(posterior.evaluations as f64 - finals as f64);
        row.evaluations.push(posterior.evaluations as f64);
        row.errors.push(posterior.log_evidence - problem.log_evidence);
        row.ses.push(posterior.log_evidence_se);
        row.ess
            .push(record.finals.last().map_or(0.0, |weights| weights.ess));
    }
    row
}

/// Prints a line for each problem: the seeds that were left to draws of the model, and of all other seeds the mean and largest number of
/// evaluations before the final draws, the mean number of all, root mean square and largest error of ln Z, the mean standard error
/// that was reported, and the effective final draws.
///
/// # Arguments
/// - `names`: the problems to solve; empty: all.
pub(crate) fn print(seeds: u64, names: &[String]) {
    println!(
        "{:3} {:>2} {:>9} {:>6} {:>6} {:>6} {:>8} {:>8} {:>8} {:>5}",
        "", "d", "left", "to 1", "max", "all", "rmse", "largest", "se", "ess"
    );
    for problem in [
        output_problems::correlated_gaussian(),
        output_problems::shear_building(),
        output_problems::thin_ridge(),
        output_problems::bekker_known_noise(),
        output_problems::bekker_unknown_noise(),
        output_problems::bekker_reparametrised(),
        output_problems::shells(),
        output_problems::eggbox(),
    ] {
        if !names.is_empty() && !names.iter().any(|name| name == problem.name) {
            continue;
        }
        let row = row(&problem, seeds);
        println!(
            "{:3} {:>2} {:>5}/{seeds:<3} {:6.0} {:6.0} {:6.0} {:8.4} {:8.4} {:8.4} {:5.0}",
            problem.name,
            problem.prior.dimension(),
            row.fallbacks,
            mean(&row.to_exponent_1),
            largest(&row.to_exponent_1),
            mean(&row.evaluations),
            root_mean_square(&row.errors),
            largest(&row.errors),
            mean(&row.ses),
            mean(&row.ess),
        );
    }
}
