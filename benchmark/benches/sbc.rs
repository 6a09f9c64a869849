//! Simulation-based calibration of the whole chain: priors, likelihood, sampler and the quasi-static model.
//!
//! `cargo bench -p benchmark --bench sbc [-- [emulated] [SETS [PARTICLES [SEED]]]]` calibrates by drawn or by emulated stages.
//! The default of 1000 data sets and 500 particles takes about four minutes of CPU time. Exits with 1 if ranks are not uniform, or if 90 %
//! intervals contain the truth too often or too rarely.

use std::process::ExitCode;

use benchmark::error::StudyError;
use benchmark::sbc::{Study, judge};

/// The number of bins, one for each rank.
const BINS: usize = 20;
/// The smallest probability of a parameter's chi-square and of its coverage.
const MIN_P: f64 = 1e-3;
/// The smallest product of the least chi-square probability and the number of parameters (Bonferroni).
const MIN_P_TOGETHER: f64 = 1e-2;

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let is_emulated = arguments.first().is_some_and(|first| first == "emulated");
    if is_emulated {
        arguments.remove(0);
    }
    let numbers: Result<Vec<u64>, _> = arguments.iter().map(|argument| argument.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: SETS, PARTICLES and SEED are whole numbers");
        return ExitCode::FAILURE;
    };
    let number = |i: usize, default: u64| numbers.get(i).copied().unwrap_or(default);
    let study = Study {
        sets: number(0, 1000) as usize,
        particles: number(1, 500) as usize,
        seed: number(2, 1),
        noise_factor: 1.0,
        is_emulated,
    };
    match report(&study) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Prints the verdicts; returns whether every threshold holds.
fn report(study: &Study) -> Result<bool, StudyError> {
    let parameters = study.parameters()?;
    let rankings = study.run()?;
    let flagged = rankings.iter().filter(|f| !f.equilibrated).count();
    let rejected: u64 = rankings.iter().map(|f| f.rejected).sum();
    println!(
        "{} data sets of 3 runs, {} particles, seed {}: {flagged} calibrations flagged as not equilibrated, {rejected} draws of \
         the prior rejected by the model and drawn again",
        study.sets, study.particles, study.seed
    );
    println!(
        "{:<24} {:>10} {:>10} {:>10}  ranks of the truth",
        "parameter", "p uniform", "in 90 %", "p of that"
    );
    let verdicts = judge(&parameters, &rankings, BINS);
    for v in &verdicts {
        let counts: Vec<String> = v.counts.iter().map(usize::to_string).collect();
        let (name, p, counts) = (&v.parameter, v.p, counts.join(" "));
        println!(
            "{name:<24} {p:>10.4} {:>10.3} {:>10.4}  {counts}",
            v.coverage, v.coverage_p
        );
    }
    let least = verdicts.iter().map(|v| v.p).fold(1.0, f64::min);
    let together = (least * verdicts.len() as f64).min(1.0);
    println!("least p times the number of parameters: {together:.4}");
    let each = verdicts.iter().all(|v| v.p > MIN_P && v.coverage_p > MIN_P);
    let good = each && together > MIN_P_TOGETHER;
    println!("{}", if good { "calibrated" } else { "NOT CALIBRATED" });
    Ok(good)
}
