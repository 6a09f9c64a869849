//! Searches as versions before migration 20 stored them: a job with `algorithm = "discovery"`, derived from that of the
//! calibration that it searches. Only the store reads these, to learn which calibration that was.

use shared::file::{FileError, FileSet};

use super::one_model::keep_model;
use super::point_job::{edited, with_algorithm};

/// The algorithm of such a job.
const ALGORITHM: &str = "discovery";

/// Whether a job is such a search.
pub fn is_earlier_search(toml: &str) -> bool {
    let job: Option<toml::Table> = toml.parse().ok();
    let sampler = job.as_ref().and_then(|job| job.get("sampler"));
    sampler.and_then(|sampler| sampler.get("algorithm")?.as_str()) == Some(ALGORITHM)
}

/// The job by which an earlier version searched the model of another.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn earlier_search(name: &str, job: &FileSet) -> Result<FileSet, FileError> {
    let one = edited(name, &job.toml, |document| keep_model(document, 0))?;
    Ok(FileSet {
        toml: with_algorithm(name, &one, ALGORITHM)?,
        files: job.files.clone(),
    })
}

/// A search's own job as this version reads it: its model by the usual algorithm.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn searched_model(name: &str, search: &FileSet) -> Result<FileSet, FileError> {
    let toml = edited(name, &search.toml, |document| {
        if let Some(sampler) = document.get_mut("sampler").and_then(|s| s.as_table_like_mut()) {
            sampler.remove("algorithm");
        }
        Ok(())
    })?;
    Ok(FileSet {
        toml,
        files: search.files.clone(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{JobFile, continued_job};

    const JOB: &str = r#"# why
[model]
kind = "scm" # here
effects = ["hard_pan"]
[sampler]
particles = 50
seed = 7
point_estimates = ["ga"]
[discovery]
apply = "auto"
"#;

    fn job(toml: &str) -> FileSet {
        FileSet {
            toml: toml.into(),
            files: [("mine.toml".to_owned(), String::new())].into(),
        }
    }

    #[test]
    fn a_search_had_the_seed_and_the_model_and_asked_for_nothing() {
        let search = earlier_search("job.toml", &job(JOB)).unwrap();
        let expected = JOB
            .replace("particles = 50\n", "")
            .replace("point_estimates = [\"ga\"]\n", "algorithm = \"discovery\"\n")
            .replace("[discovery]\napply = \"auto\"\n", "");
        assert_eq!(search.toml, expected);
        assert!(is_earlier_search(&search.toml) && !is_earlier_search(JOB));
        assert_eq!(search.files, job(JOB).files);
        let continued = continued_job("job.toml", &job(JOB)).unwrap();
        let again = earlier_search("job.toml", &continued).unwrap();
        assert_eq!(again.toml, expected, "equal models have equal searches");
    }

    #[test]
    fn this_version_reads_its_model_and_not_its_algorithm() {
        let search = earlier_search("job.toml", &job(JOB)).unwrap();
        let refused = JobFile::parse("job.toml", &search.toml).unwrap_err().to_string();
        assert!(refused.contains("unknown algorithm \"discovery\""), "{refused}");
        let model = searched_model("job.toml", &search).unwrap();
        let parsed = JobFile::parse("job.toml", &model.toml).unwrap();
        assert_eq!(parsed.model.effects, ["hard_pan"]);
        assert_eq!(parsed.algorithm.seed(), 7);
    }
}
