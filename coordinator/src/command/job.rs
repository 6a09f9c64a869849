//! A job on disk with the files it names.

use std::path::{Path, PathBuf};

use shared::experiment::Experiment;
use shared::file::{FileError, FileSet, read_text, sibling};

use crate::service::experiment_of;
use crate::spec::Spec;

/// A job with everything it names, read and validated.
pub(super) struct JobOnDisk {
    /// Name for lists and folders.
    pub(super) name: String,
    /// Text of the job.
    pub(super) toml: String,
    /// Its experiment.
    pub(super) experiment: FileSet,
    /// What they mean.
    pub(super) spec: Spec,
}

/// Reads and validates a job and its experiment.
pub(super) fn read(path: &Path) -> Result<JobOnDisk, FileError> {
    let job_name = path.display().to_string();
    let toml = read_text(path)?;
    let experiment_path = sibling(path, &experiment_of(&job_name, &toml)?);
    let experiment_name = experiment_path.display().to_string();
    let experiment = Experiment::read_files(&experiment_path)?;
    let spec = Spec::new(&job_name, &toml, &experiment_name, &experiment)?;
    Ok(JobOnDisk {
        name: name(path),
        toml,
        experiment,
        spec,
    })
}

/// The job's name: its file's, or its folder's where the file is just `job.toml`.
fn name(path: &Path) -> String {
    let text = |s: Option<&std::ffi::OsStr>| s.map(|s| s.to_string_lossy().into_owned());
    let stem = text(path.file_stem()).unwrap_or_else(|| "job".into());
    if stem != "job" {
        return stem;
    }
    let absolute: PathBuf = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    text(absolute.parent().and_then(Path::file_name)).unwrap_or(stem)
}
