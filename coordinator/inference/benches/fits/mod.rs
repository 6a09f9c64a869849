//! The cost of the point estimates, as a table.
//!
//! For each problem and algorithm: how many seeds came within 0.1 nats of the optimum, their mean evaluations until
//! then, and those of all seeds to their end; how often the stop reason was an early one; the worst loss in nats.
//!
//! The Levenberg-Marquardt fit takes predictions, so it has the problems that are sums of squares: a, b, and c5 with the
//! noise sd itself as a parameter (c5 has its decimal logarithm, whose density has another maximum). It keeps no history,
//! so the evaluations until then are unknown.

mod residuals;

use inference::evolution::{CmaEsSettings, EvolutionSettings, GaSettings};
use inference::point_estimate::ModeEstimate;

use crate::problems::{self, Problem};

/// A loss that nobody would notice in a posterior, in nats.
const CLOSE: f64 = 0.1;

/// A line of the table.
fn row(name: &str, algorithm: &str, optimum: f64, runs: &[ModeEstimate]) {
    let close = |value: f64| value > optimum - CLOSE;
    let hits: Vec<&ModeEstimate> = runs.iter().filter(|run| close(run.log_posterior())).collect();
    let reached = |run: &ModeEstimate| {
        let generation = run.history.iter().find(|g| g.best.is_some_and(close))?;
        Some(generation.evaluations)
    };
    let until: Vec<u64> = hits.iter().filter_map(|run| reached(run)).collect();
    let until = match until.len() {
        0 => "-".to_owned(),
        count => (until.iter().sum::<u64>() / count as u64).to_string(),
    };
    let all = runs.iter().map(|run| run.evaluations).sum::<u64>() / runs.len() as u64;
    let early = runs.iter().filter(|run| run.stop.is_early()).count();
    let loss = runs
        .iter()
        .fold(0.0_f64, |worst, run| worst.max(optimum - run.log_posterior()));
    println!(
        "{name:5} {algorithm:16} {:4}/{:<3} {until:>8} {all:>8} {early:>6} {loss:>9.3}",
        hits.len(),
        runs.len()
    );
}

fn evolved(problem: &Problem, settings: impl Fn(u64) -> EvolutionSettings, seeds: u64) -> Vec<ModeEstimate> {
    (1..=seeds)
        .map(|seed| problem.evolve(settings(seed)).estimate().unwrap().clone())
        .collect()
}

/// Prints the table.
pub(crate) fn print(seeds: u64) {
    println!(
        "{:5} {:16} {:>8} {:>8} {:>8} {:>6} {:>9}",
        "", "algorithm", "close", "until", "to end", "short", "worst"
    );
    let genetic = |seed| {
        EvolutionSettings::Ga(GaSettings {
            seed,
            ..GaSettings::default()
        })
    };
    let adapting = |seed, restarts| {
        EvolutionSettings::CmaEs(CmaEsSettings {
            seed,
            restarts,
            ..CmaEsSettings::default()
        })
    };
    for problem in [
        problems::correlated_gaussian(),
        problems::shear_building(),
        problems::thin_ridge(),
        problems::bekker_known_noise(),
        problems::bekker_unknown_noise(),
        problems::bekker_reparametrised(),
        problems::shells(),
        problems::eggbox(),
        problems::skew(),
    ] {
        let print =
            |algorithm: &str, runs: &[ModeEstimate]| row(problem.name, algorithm, problem.optimum, runs);
        print("ga", &evolved(&problem, genetic, seeds));
        print("cma-es", &evolved(&problem, |seed| adapting(seed, 4), seeds));
        print(
            "cma-es, one run",
            &evolved(&problem, |seed| adapting(seed, 0), seeds),
        );
    }
    residuals::print(seeds);
}
