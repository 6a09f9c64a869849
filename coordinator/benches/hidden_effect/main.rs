//! How well the missing effect is found, on experiments whose truth is known.
//!
//! `cargo bench -p coordinator --bench hidden_effect [-- EXPERIMENTS [SEED [LINES]]]`: as many experiments with one hidden effect of
//! the catalogue as without, 200 of each where nothing is said, with a line for each where LINES is 1; then the four experiments of
//! `tests/data`.

mod models;
mod pipeline;
mod study;
mod tally;

use std::process::ExitCode;

use models::Models;
use shared::file::FileSet;
use tally::{Fate, Tally};

/// The experiments of another implementation of the model, with what it hid.
const SYNTHETIC: [&str; 4] = [
    "nothing-hidden",
    "shear-mobilisation",
    "undetectable",
    "outside-the-catalogue",
];

fn main() -> ExitCode {
    let numbers: Result<Vec<u64>, _> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .map(|a| a.parse())
        .collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: EXPERIMENTS, SEED and LINES are whole numbers");
        return ExitCode::FAILURE;
    };
    let number = |i: usize, usual: u64| numbers.get(i).copied().unwrap_or(usual);
    match drawn(number(0, 200), number(1, 1), number(2, 0) == 1).and_then(|()| synthetic()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Experiments drawn from the priors, each effect in turn.
fn drawn(count: u64, seed: u64, has_lines: bool) -> Result<(), String> {
    let models = Models::new(study::JOB, &study::experiment())?;
    let effects = models.candidates.len();
    println!(
        "{effects} candidates; {} slips, {} loads, {} speeds; noise {} of each channel's rms; seed {seed}",
        study::SLIPS.len(),
        study::LOADS_N.len(),
        study::SPEEDS_M_S.len(),
        study::NOISE
    );
    for (name, reason) in &models.left_out {
        println!("left out: {name}: {reason}");
    }
    let mut tally = Tally::default();
    for k in 0..2 * count {
        let hidden = (k % 2 == 0).then_some((k / 2) as usize % effects);
        let case = study::draw(&models, hidden, seed, k)?;
        let finding = study::search(&models, &case.measured)?;
        let separation = match hidden {
            None => None,
            Some(effect) => {
                let clear = study::search(&models, &case.noise_free)?;
                tally::separation(effect, &clear, &case.noise_free)
            }
        };
        let fate = Fate::new(hidden, &finding, separation);
        if has_lines {
            println!("{}", fate.line(&models, &case, &finding));
        }
        tally.add(fate);
    }
    println!("{tally}");
    Ok(())
}

/// The experiments of `tests/data`.
fn synthetic() -> Result<(), String> {
    for name in SYNTHETIC {
        let folder = format!("{}/../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
        let read = |file: &str| {
            let path = format!("{folder}/{file}");
            std::fs::read_to_string(&path).map_err(|e| format!("{path}: {e}"))
        };
        let experiment = FileSet {
            toml: read("experiment.toml")?,
            files: [("runs.csv".to_owned(), read("runs.csv")?)].into(),
        };
        let job = FileSet {
            toml: read("job.toml")?,
            files: Default::default(),
        };
        let begin = std::time::Instant::now();
        let made = coordinator::discovery::Models::new(&job, &experiment, 3).map_err(|e| e.to_string())?;
        println!("models {:?}", begin.elapsed());
        drop(made);
        let (models, answer) = pipeline::inquire(&job, &experiment)?;
        println!("\n{name}: {:?} {:?}", answer.verdict, begin.elapsed());
        println!(
            "  {:?} {:?} to name {} all {}",
            answer.chi_square.map(|c| (c.value, c.p())),
            answer.chi_square_best.map(|c| (c.value, c.p())),
            answer.evaluations_to_name,
            answer.evaluations
        );
        let mut judged = answer.judged.clone();
        judged.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        let name_of =
            |k: Option<usize>| k.map_or("none".to_owned(), |k| models.task().candidates()[k].name.clone());
        for j in judged.iter().take(6) {
            println!(
                "  {:<28} ln BF {:8.2} P {:.3} class {} {:?} {:?}",
                name_of(j.candidate),
                j.log_bayes_factor,
                j.probability,
                j.class,
                j.method,
                j.parameters
            );
        }
        println!(
            "  not in library {:?}; best set {:?}",
            answer.not_in_library,
            answer
                .best_set
                .iter()
                .map(|k| name_of(Some(*k)))
                .collect::<Vec<_>>()
        );
        if let Some(o) = &answer.outside {
            println!("  outside {} {:?}", name_of(Some(o.candidate)), o);
        }
        for n in &answer.next_runs {
            println!("  next {:?}", n);
        }
    }
    Ok(())
}
