//! Print the sampler's errors on problems with known answers.
//!
//! Columns: mean evaluations; rmse and bias of the log-evidence, mean reported standard error; flagged runs,
//! rmse of the others, how many of them are off by more than 4 standard errors + 0.3; worst drift; stages,
//! steps per stage; estimated / true sd and mean errors in sd, a derived quantity last.
//!
//! Below it, unless one problem was asked for: what it costs to find the most probable parameters (`fits`).
//!
//! `cargo bench -p inference --bench sampler_table [-- SEEDS [LABEL [PROBLEM]]]` with the start of a row's label, or `-- fits
//! [SEEDS]`, or `-- emulated [SEEDS [PROBLEM...]]` for the sampler that emulates outputs (`emulated`).

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

#[path = "../tests/output_problems.rs"]
mod output_problems;
#[path = "../tests/problems.rs"]
mod problems;

mod emulated;
mod fits;

use inference::{Algorithm, StageMethod, TmcmcSettings};
use problems::Problem;

/// Errors of one problem over seeds.
fn row(problem: &Problem, label: &str, settings: TmcmcSettings, seeds: u64) {
    let (mut evaluations, mut errors, mut se) = (0.0, Vec::new(), Vec::new());
    let (mut flagged, mut worst_z, mut silent) = (0, 0.0_f64, 0);
    let (mut ratios, mut shifts) = (vec![0.0; problem.sd.len() + 1], vec![0.0; problem.sd.len() + 1]);
    let (mut stages, mut steps) = (0, 0);
    let mut clean = Vec::new();
    for seed in 1..=seeds {
        let sampler = problem.run(TmcmcSettings { seed, ..settings });
        let Some(posterior) = sampler.posterior() else {
            println!("{} {label}: {:?}", problem.name, sampler.failure());
            return;
        };
        let error = posterior.log_evidence - problem.log_evidence;
        evaluations += posterior.evaluations as f64 / seeds as f64;
        flagged += u32::from(!posterior.equilibrated);
        silent += u32::from(posterior.equilibrated && error.abs() > 4.0 * posterior.log_evidence_se + 0.3);
        errors.push(error);
        if posterior.equilibrated {
            clean.push(error);
        }
        se.push(posterior.log_evidence_se);
        worst_z = sampler
            .stages()
            .iter()
            .fold(worst_z, |worst, stage| worst.max(stage.drift_z.abs()));
        stages += sampler.stages().len();
        steps += sampler.stages().iter().map(|stage| stage.steps).sum::<usize>();
        let mut column = |index: usize, values: Vec<f64>, mean: f64, sd: f64| {
            let (estimate, spread) = inference::diagnostics::mean_and_sd(&values).unwrap_or((0.0, 0.0));
            ratios[index] += spread / sd / seeds as f64;
            shifts[index] += (estimate - mean) / sd / seeds as f64;
        };
        for (index, (&mean, &sd)) in problem.mean.iter().zip(&problem.sd).enumerate() {
            column(
                index,
                posterior.particles.iter().map(|p| p.theta[index]).collect(),
                mean,
                sd,
            );
        }
        if let Some((derive, mean, sd)) = problem.derived {
            column(
                problem.sd.len(),
                posterior.particles.iter().map(|p| derive(&p.theta)).collect(),
                mean,
                sd,
            );
        }
    }
    if problem.derived.is_none() {
        ratios.pop();
        shifts.pop();
    }
    let count = seeds as f64;
    let bias = errors.iter().sum::<f64>() / count;
    let rmse = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
    let se = se.iter().sum::<f64>() / count;
    let clean: f64 = clean.iter().map(|e| e * e).sum::<f64>() / (clean.len().max(1)) as f64;
    let clean = if clean > 0.0 {
        format!("{:.3}", clean.sqrt())
    } else {
        "-".to_owned()
    };
    let text = |values: &[f64]| {
        values
            .iter()
            .map(|x| format!("{x:.2}"))
            .collect::<Vec<_>>()
            .join(" ")
    };
    println!(
        "{:4} {label:22} {evaluations:8.0} {rmse:7.3} {bias:+7.3} {se:6.3} {flagged:4}/{seeds:<3} {clean:>6} {silent:6} {worst_z:6.1} {:6.1} {:5.1}  {:<28}  {}",
        problem.name,
        stages as f64 / count,
        steps as f64 / stages as f64,
        text(&ratios),
        text(&shifts),
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    if arguments.first().is_some_and(|word| word == "fits") {
        let seeds = arguments.get(1).and_then(|text| text.parse().ok());
        return fits::print(seeds.unwrap_or(10));
    }
    if arguments.first().is_some_and(|word| word == "emulated") {
        let seeds = arguments.get(1).and_then(|text| text.parse().ok());
        return emulated::print(seeds.unwrap_or(20), arguments.get(2..).unwrap_or_default());
    }
    let number = |index: usize| arguments.get(index).and_then(|text| text.parse::<usize>().ok());
    let seeds = number(0).unwrap_or(20) as u64;
    println!(
        "{:4} {:22} {:>8} {:>7} {:>7} {:>6} {:>8} {:>6} {:>6} {:>6} {:>6} {:>5}  {:<28}  mean errors / sd",
        "",
        "settings",
        "evals",
        "rmse",
        "bias",
        "se",
        "flagged",
        "clean",
        "silent",
        "max|z|",
        "stages",
        "steps",
        "sd ratios"
    );
    let base = TmcmcSettings::default();
    // With the settings that make about 20 000 evaluations (c3, c4: the flags are the point), and the
    // log-evidence rmse of prototypes of these samplers: Ching-Chen 2007, the best tempered variant, the goal.
    let problems = [
        (problems::correlated_gaussian(), 160, 10, "1.87, .37, goal .4"),
        (problems::shear_building(), 285, 10, ".25, .12, goal .2"),
        (problems::thin_ridge(), 250, 10, ".30, .16, goal .2"),
        (problems::bekker_reparametrised(), 155, 20, ".97, .37, goal .4"),
        (problems::shells(), 585, 10, ".11, .07, goal .2"),
        (problems::eggbox(), 585, 10, "-"),
        (problems::skew(), 1240, 10, "-"),
        (
            problems::bekker_known_noise(),
            400,
            10,
            "13.2, .72, right or flagged",
        ),
        (
            problems::bekker_unknown_noise(),
            400,
            10,
            "-, -, right or flagged",
        ),
    ];
    for (problem, particles, min_moves, reference) in &problems {
        if arguments.get(2).is_some_and(|name| name != problem.name) {
            continue;
        }
        println!("{:4} reference rmse at 20 000: {reference}", problem.name);
        let moves = TmcmcSettings {
            stages: StageMethod::Moves,
            ..base
        };
        let lean = TmcmcSettings {
            particles: *particles,
            moves: [*min_moves, 60],
            ..moves
        };
        let original = |algorithm| TmcmcSettings { algorithm, ..moves };
        for (label, settings) in [
            ("draws, 1000".to_owned(), base),
            (format!("moves, {particles} [{min_moves}, 60]"), lean),
            ("moves, 1000 [10, 60]".to_owned(), moves),
            ("ching-chen-2007".to_owned(), original(Algorithm::ChingChen2007)),
            ("basis".to_owned(), original(Algorithm::Basis)),
        ] {
            if arguments.get(1).is_none_or(|start| label.starts_with(start)) {
                row(problem, &label, settings, seeds);
            }
        }
    }
    if arguments.len() < 2 {
        println!();
        fits::print(seeds);
    }
}
