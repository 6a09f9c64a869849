//! The experiments of `tests/data`, from another implementation of the model.

use shared::file::FileSet;

use crate::hidden_effect::study::error::StudyError;
use crate::hidden_effect::study::local_search::LocalSearch;

const NAMES: [&str; 4] = [
    "nothing-hidden",
    "shear-mobilisation",
    "undetectable",
    "outside-the-catalogue",
];

/// Searches each, and prints what was found.
pub fn run() -> Result<(), StudyError> {
    for name in NAMES {
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
        let mut local = LocalSearch::new(&job, &experiment, 3)?;
        let conclusion = local.run()?;
        let candidates = local.models.task().candidates();
        let name_of = |k: Option<usize>| k.map_or("none", |k| candidates[k].name.as_str());
        println!(
            "{name}: {:?}, {} evaluations",
            conclusion.verdict, conclusion.evaluations
        );
        let mut judged: Vec<_> = conclusion.ranking.effects.iter().collect();
        judged.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        for j in judged.iter().take(6) {
            println!(
                "  {:<28} ln BF {:8.2} P {:.3} class {}",
                name_of(j.candidate),
                j.log_bayes_factor,
                j.probability,
                j.class
            );
        }
        if let Some(outside) = &conclusion.outside {
            println!(
                "  law {} ln BF {:.2}, left out {:?}",
                name_of(Some(outside.candidate)),
                outside.log_bayes_factor,
                outside.left_out_nats
            );
        }
    }
    Ok(())
}
