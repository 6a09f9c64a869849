//! One of the models that a job compares, as the job of that model alone.

use shared::file::{FileError, FileSet};
use shared::model::ModelKind;
use toml_edit::{DocumentMut, Item, Table};

use super::point_job::{edited, keep_candidates};
use crate::table::model_entry::is_shared_by;

/// The job of one of the models that a job compares: its table becomes `[model]`, and `[priors]` holds the lines of all models that
/// concern it, then its own.
///
/// # Arguments
/// - `number`: of the model, from 0, in the order of the job.
///
/// # Errors
/// [`FileError`] where the text is no job, or has fewer models.
pub fn model_job(name: &str, job: &FileSet, number: usize) -> Result<FileSet, FileError> {
    let toml = edited(name, &job.toml, |document| {
        keep_model(document, number)?;
        keep_candidates(document);
        Ok(())
    })?;
    Ok(FileSet {
        toml,
        files: job.files.clone(),
    })
}

/// Puts a model in the place of all; a job with a table `[model]` stays as it is.
pub(super) fn keep_model(document: &mut DocumentMut, number: usize) -> Result<(), &'static str> {
    let Some(models) = document.remove("models") else {
        return Ok(());
    };
    let models = models.into_array_of_tables();
    let models = models.map_err(|_| "[[models]] is not a list of tables")?;
    let mut model: Table = models.get(number).ok_or("[[models]] has fewer models")?.clone();
    let kind = model.get("kind").and_then(Item::as_str).and_then(ModelKind::find);
    let kind = kind.ok_or("[[models]] has a model of no known kind")?;
    let own = model.remove("priors");
    let own = own.as_ref().and_then(Item::as_table_like);
    let shared = document.remove("priors");
    let shared = shared.as_ref().and_then(Item::as_table_like);
    let mut priors = Table::new();
    for (key, item) in shared.into_iter().flat_map(|table| table.iter()) {
        let is_own = own.is_some_and(|own| own.contains_key(key));
        if is_shared_by(kind, key) && !is_own && !model.contains_key(key) {
            priors.insert(key, item.clone());
        }
    }
    for (key, item) in own.into_iter().flat_map(|table| table.iter()) {
        priors.insert(key, item.clone());
    }
    model.set_position(None);
    document.insert("model", Item::Table(model));
    if !priors.is_empty() {
        document.insert("priors", Item::Table(priors));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JobFile;

    const JOB: &str = "experiment = \"e.toml\"\n\n[[models]]\nkind = \"quasi_static\"\nn = 1.0\n\n[[models]]\nkind = \"rft\"\n[models.priors]\nsurface_friction = 0.4\n\"noise.torque_n_m\" = { half_normal = 1.0 }\n\n[priors]\nlog10_p_ref = { uniform = [4.0, 6.0] } # stiff\nkappa = 0.0\nn = 1.1\nfriction_angle_deg = { uniform = [20.0, 40.0] }\n\"noise.torque_n_m\" = { half_normal = 0.5 }\n\n[sampler]\nseed = 3\n";

    fn job() -> FileSet {
        FileSet {
            toml: JOB.into(),
            ..FileSet::default()
        }
    }

    #[test]
    fn each_model_alone_has_its_parameters_in_the_order_of_the_whole_job() {
        let models = JobFile::parse_models("job.toml", JOB).unwrap();
        assert_eq!(models.others.len(), 1);
        for (number, whole) in [&models.first, &models.others[0]].into_iter().enumerate() {
            let alone =
                JobFile::parse("job.toml", &model_job("job.toml", &job(), number).unwrap().toml).unwrap();
            let names = |job: &JobFile| {
                job.priors
                    .iter()
                    .map(|p| (p.name.clone(), p.value.clone()))
                    .collect::<Vec<_>>()
            };
            assert_eq!(names(&alone), names(whole));
            assert_eq!((&alone.model, alone.algorithm), (&whole.model, whole.algorithm));
            assert_eq!((whole.models, alone.models), (2, 1));
        }
        let own = &models.others[0].priors;
        let names: Vec<&str> = own.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(
            names,
            ["surface_friction", "noise.torque_n_m"],
            "nothing of a Bekker soil"
        );
        assert_eq!(own[0].line, 10);
        let first: Vec<&str> = models.first.priors.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(
            first,
            ["log10_p_ref", "kappa", "friction_angle_deg", "noise.torque_n_m"],
            "n is fixed there"
        );
    }

    #[test]
    fn a_job_of_one_model_is_left_alone() {
        let job = FileSet {
            toml: "[model]\nkind = \"scm\" # here\n".into(),
            ..FileSet::default()
        };
        assert_eq!(model_job("job.toml", &job, 0).unwrap(), job);
    }

    #[test]
    fn mistakes_of_a_later_model_have_their_line() {
        let broken = |from: &str, to: &str| {
            let error = JobFile::parse("job.toml", &JOB.replacen(from, to, 1)).unwrap_err();
            error.to_string()
        };
        assert_eq!(
            broken("kind = \"rft\"", "kind = \"rtf\""),
            "job.toml line 7: [[models]] unknown kind \"rtf\"; the nearest known is \"rft\""
        );
        assert_eq!(
            broken("kappa = 0.0", "bearing_credit = 0.3"),
            "job.toml line 15: bearing_credit is a parameter of none of quasi_static, rft"
        );
        assert!(
            broken("[[models]]\nkind = \"rft\"", "[model]\nkind = \"rft\"").contains("exclude each other")
        );
        let one = "[[models]]\nkind = \"scm\"\n";
        let error = JobFile::parse("job.toml", one).unwrap_err().to_string();
        assert!(error.contains("takes 2 to 8"), "{error}");
    }
}
