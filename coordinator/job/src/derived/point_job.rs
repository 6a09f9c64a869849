//! The jobs that follow from a job of a study: a point estimate beside a sample, the search of its model.

use shared::file::FileError;
use toml_edit::{DocumentMut, Item};

use crate::table::algorithm_settings::AlgorithmSettings;

/// The text of a job with a fit or a search in place of its sampler; the seed and everything else stay as written.
///
/// So a point estimate is stored, taken up again and shown like any other calibration.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn point_job(name: &str, toml: &str, algorithm: &AlgorithmSettings) -> Result<String, FileError> {
    let text = with_algorithm(name, toml, algorithm.name())?;
    match algorithm {
        AlgorithmSettings::Fit(_) => edited(name, &text, |document| {
            // The sample is the posterior: beside it no approximation is drawn from.
            document["sampler"]["particles"] = toml_edit::value(0);
            Ok(())
        }),
        _ => Ok(text),
    }
}

/// The same with another algorithm by its usual settings. Of the table `[discovery]` only what says which candidates there are stays.
pub(super) fn with_algorithm(name: &str, toml: &str, algorithm: &str) -> Result<String, FileError> {
    edited(name, toml, |document| {
        let sampler = document
            .entry("sampler")
            .or_insert(Item::Table(toml_edit::Table::new()));
        let sampler = sampler.as_table_like_mut().ok_or("[sampler] must be a table")?;
        let foreign: Vec<String> = sampler
            .iter()
            .map(|(key, _)| key.to_owned())
            .filter(|key| key != "seed")
            .collect();
        for key in foreign {
            sampler.remove(&key);
        }
        sampler.insert("algorithm", toml_edit::value(algorithm));
        keep_candidates(document);
        Ok(())
    })
}

/// Removes `[discovery]` but for what says which candidates there are: what follows from a job asks for nothing itself.
pub(super) fn keep_candidates(document: &mut DocumentMut) {
    let Some(discovery) = document.get_mut("discovery").and_then(Item::as_table_like_mut) else {
        return;
    };
    let others: Vec<String> = discovery.iter().map(|(key, _)| key.to_owned()).collect();
    for key in others
        .iter()
        .filter(|key| !["priors", "other_kind"].contains(&key.as_str()))
    {
        discovery.remove(key);
    }
    if discovery.is_empty() {
        document.remove("discovery");
    }
}

/// The text of a job with a change; what the change leaves alone stays as it is written.
pub(super) fn edited(
    name: &str,
    toml: &str,
    change: impl FnOnce(&mut DocumentMut) -> Result<(), &'static str>,
) -> Result<String, FileError> {
    let fail = |message: String| FileError::whole(name, message);
    let mut document: DocumentMut = toml
        .parse()
        .map_err(|e: toml_edit::TomlError| fail(e.to_string()))?;
    change(&mut document).map_err(|e| fail(e.to_owned()))?;
    Ok(document.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JobFile;

    const JOB: &str = "# why\n[model]\nkind = \"scm\" # here\n[sampler]\nparticles = 50\nmoves = [2, 4]\nseed = 7\npoint_estimates = [\"ga\", \"lm\"]\n";

    #[test]
    fn a_point_estimate_has_the_job_s_seed_and_the_usual_settings() {
        let job = JobFile::parse("job.toml", JOB).unwrap();
        let names: Vec<&str> = job.point_estimates.iter().map(AlgorithmSettings::name).collect();
        assert_eq!(names, ["ga", "lm"]);
        for algorithm in &job.point_estimates {
            let text = point_job("job.toml", JOB, algorithm).unwrap();
            let own = JobFile::parse("job.toml", &text).unwrap();
            assert_eq!((own.algorithm, own.algorithm.seed()), (*algorithm, 7));
            assert!(own.point_estimates.is_empty(), "it has none beside it");
            assert!(
                text.starts_with("# why\n[model]\nkind = \"scm\" # here\n"),
                "{text}"
            );
        }
    }

    #[test]
    fn without_a_seed_the_usual_one_is_the_same_for_all() {
        let job = JOB.replace("seed = 7\n", "");
        let parsed = JobFile::parse("job.toml", &job).unwrap();
        for algorithm in &parsed.point_estimates {
            let text = point_job("job.toml", &job, algorithm).unwrap();
            assert_eq!(JobFile::parse("job.toml", &text).unwrap().algorithm, *algorithm);
        }
    }

    #[test]
    fn what_is_no_point_estimate_is_refused_by_name() {
        for (list, reason) in [
            ("[\"gaa\"]", "[sampler] unknown point estimate \"gaa\""),
            ("[\"tmcmc\"]", "[sampler] unknown point estimate \"tmcmc\""),
            ("[\"lm\", \"lm\"]", "[sampler] point_estimates names lm twice"),
        ] {
            let job = JOB.replace("[\"ga\", \"lm\"]", list);
            let error = JobFile::parse("job.toml", &job).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
        let job = JOB.replace("particles = 50\nmoves = [2, 4]", "algorithm = \"ga\"");
        let error = JobFile::parse("job.toml", &job).unwrap_err().to_string();
        assert!(
            error.contains("point_estimates belongs to algorithm tmcmc"),
            "{error}"
        );
    }
}
