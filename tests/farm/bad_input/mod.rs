//! Wrong inputs, each of which gives one clear message and a nonzero exit code, and leaves nothing behind.

mod bevameter;
mod experiments;
pub(super) mod gallery;
mod meshes;
mod places;
mod requests;

use std::path::Path;

use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};

/// A small `plates.csv`.
const PLATES: &str = "test,plate_radius_m,sinkage_m,pressure_pa\np1,0.04,0.002,9000\np1,0.04,0.006,\n";
/// A small `shear.csv`.
const SHEAR: &str = "test,normal_stress_pa,shear_displacement_m,shear_stress_pa\nr1,20000,0.012,\n";

/// Returns the message with which both `check` and `run` refuse a job; `run` must leave no folder behind.
#[track_caller]
pub(super) fn refusal(job: &Job) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    refusal_in(&job.write(folder.path()), folder.path())
}

/// Returns the message of a job that lies in a folder and must be refused.
#[track_caller]
pub(super) fn refusal_in(path: &Path, folder: &Path) -> String {
    let out = folder.join("out");
    let path = path.display().to_string();
    let checked = run(coordinator(["check", &path])).refusal();
    let ran = run(coordinator(["run", &path, "--out", &out.display().to_string()])).refusal();
    assert_eq!(checked, ran);
    assert!(!out.exists(), "a folder was left behind for: {ran}");
    assert_eq!(ran.lines().count(), 1, "more than one line: {ran}");
    ran.replace(&format!("{}/", folder.display()), "")
}

/// Asserts the whole message with which a job is refused.
#[track_caller]
pub(super) fn refused(job: Job, message: &str) {
    assert_eq!(refusal(&job), message);
}
