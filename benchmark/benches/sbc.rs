//! Simulation-based calibration of the whole chain: priors, likelihood, sampler and the quasi-static model.
//!
//! `cargo bench -p benchmark --bench sbc [-- SETS [PARTICLES [SEED]]]`: 1000 data sets and 500 particles where nothing is said, about
//! four minutes of CPU time. Exits with 1 where ranks are not uniform or intervals do not hold what they promise. `study` says how.

use std::process::ExitCode;

use benchmark::sbc::{Study, judge};

/// Bins of the ranks, a rank each.
const BINS: usize = 20;
/// No parameter's chi-square, and no coverage, may be less probable than this.
const MIN_P: f64 = 1e-3;
/// The least of all chi-square probabilities, times their number (Bonferroni).
const MIN_P_TOGETHER: f64 = 1e-2;

fn main() -> ExitCode {
    let numbers: Result<Vec<u64>, _> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .map(|a| a.parse())
        .collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: SETS, PARTICLES and SEED are whole numbers");
        return ExitCode::FAILURE;
    };
    let number = |i: usize, usual: u64| numbers.get(i).copied().unwrap_or(usual);
    let study = Study {
        sets: number(0, 1000) as usize,
        particles: number(1, 500) as usize,
        seed: number(2, 1),
        noise_factor: 1.0,
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

/// Prints what came out; whether every threshold holds.
fn report(study: &Study) -> Result<bool, String> {
    let parameters = study.parameters()?;
    let fates = study.run()?;
    let flagged = fates.iter().filter(|f| !f.equilibrated).count();
    let refused: u64 = fates.iter().map(|f| f.refused).sum();
    println!(
        "{} data sets of 3 runs, {} particles, seed {}: {flagged} calibrations flagged as not equilibrated, {refused} draws of \
         the prior refused by the model and drawn again",
        study.sets, study.particles, study.seed
    );
    println!(
        "{:<24} {:>10} {:>10} {:>10}  ranks of the truth",
        "parameter", "p uniform", "in 90 %", "p of that"
    );
    let verdicts = judge(&parameters, &fates, BINS);
    for v in &verdicts {
        let counts: Vec<String> = v.counts.iter().map(usize::to_string).collect();
        println!(
            "{:<24} {:>10.4} {:>10.3} {:>10.4}  {}",
            v.parameter,
            v.p,
            v.coverage,
            v.coverage_p,
            counts.join(" ")
        );
    }
    let least = verdicts.iter().map(|v| v.p).fold(1.0, f64::min);
    let of_all = (least * verdicts.len() as f64).min(1.0);
    println!("least p times the number of parameters: {of_all:.4}");
    let each = verdicts.iter().all(|v| v.p > MIN_P && v.coverage_p > MIN_P);
    let good = each && of_all > MIN_P_TOGETHER;
    println!("{}", if good { "calibrated" } else { "NOT CALIBRATED" });
    Ok(good)
}
