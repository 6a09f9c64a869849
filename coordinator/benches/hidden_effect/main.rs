//! How well the missing effect is found, on experiments whose truth is known.
//!
//! `cargo bench -p coordinator --bench hidden_effect [-- EXPERIMENTS [SEED [LINES]]]`: as many experiments with one hidden effect of
//! the catalogue as without, 200 of each where nothing is said, with a line for each where LINES is 1; then the four experiments of
//! `tests/data`.

mod models;
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
        let models = Models::new(&read("job.toml")?, &experiment)?;
        let finding = study::search(&models, &models.base.spec.likelihood)?;
        let data = models.base.spec.likelihood.data();
        let measured: Vec<f64> = data.iter().map(|d| d.value).collect();
        let perfect = models.base.spec.likelihood.log_likelihood(&measured, &[]);
        let perfect = perfect.map_err(|e| e.to_string())?.value();
        println!("\n{name}: {} data, {:?}", data.len(), finding.spent);
        for judged in finding.ranked().into_iter().take(5) {
            println!(
                "  {:<28} ln BF {:8.2}  P {:.3}  class {:2} ({:.3})  chi2 {:6.1}  {:?}",
                models.name(judged.candidate),
                judged.log_bayes_factor,
                judged.probability,
                judged.class,
                finding.of_class(judged.class),
                2.0 * (perfect - judged.log_likelihood),
                judged.method
            );
        }
        println!("  {:<28} P {:.3}", "none", finding.of_class(0));
    }
    Ok(())
}
