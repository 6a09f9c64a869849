//! The job by which a level that is left out is predicted.

use shared::file::{FileError, FileSet};

use super::discovery_job::continued_job;
use super::point_job::with_algorithm;
use crate::table::algorithm_settings::AlgorithmName;

/// A job without point estimates and search of its own, by `lm` with its usual settings, or by the job's own algorithm.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn validation_job(name: &str, job: &FileSet, by_own_algorithm: bool) -> Result<FileSet, FileError> {
    let continued = continued_job(name, job)?;
    Ok(match by_own_algorithm {
        true => continued,
        false => FileSet {
            toml: with_algorithm(name, &continued.toml, AlgorithmName::Lm.name())?,
            ..continued
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AlgorithmSettings, JobFile};

    #[test]
    fn the_model_stays_and_what_a_study_would_do_besides_goes() {
        let toml = "[model]\nkind = \"quasi_static\"\neffects = [\"adhesion\"]\n[sampler]\nparticles = 50\nseed = 7\npoint_estimates = [\"ga\"]\n[discovery]\napply = \"auto\"\n";
        let job = FileSet {
            toml: toml.into(),
            files: [("mine.toml".into(), "x".into())].into(),
        };
        let of = |by_own| {
            let own = validation_job("job.toml", &job, by_own).unwrap();
            assert_eq!(own.files, job.files);
            assert!(
                own.toml.contains("effects = [\"adhesion\"]") && !own.toml.contains("auto"),
                "{}",
                own.toml
            );
            JobFile::parse("job.toml", &own.toml).unwrap()
        };
        let (fitted, sampled) = (of(false), of(true));
        assert!(
            matches!(fitted.algorithm, AlgorithmSettings::Fit(settings) if settings.draws > 0 && settings.seed == 7)
        );
        assert!(matches!(sampled.algorithm, AlgorithmSettings::Sample(settings) if settings.particles == 50));
        assert!(sampled.point_estimates.is_empty());
    }
}
