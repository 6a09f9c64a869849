//! Files of a job that are missing or not text, through `check` and `run`.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};

use super::refusal_in;

#[test]
fn the_job_of_the_gallery_is_good() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path()).display().to_string();
    let text = run(coordinator(["check", &path])).success();
    assert_contains!(text, "24 fit runs with 72 measurements, 16 holdout runs");
    assert_contains!(
        text,
        "expected evaluations",
        "expected simulations",
        "expected core hours"
    );
}

#[test]
fn files_that_are_not_there_or_not_text_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path());
    let refusal = |path: &Path| refusal_in(path, folder.path());
    assert!(
        refusal(&folder.path().join("jop.toml"))
            .starts_with("jop.toml: there is no such file; the nearest in its folder is")
    );
    let directory = refusal(folder.path());
    assert_contains!(directory, "directory");

    let garbage: Vec<u8> = (0..=255).cycle().take(4096).collect();
    for name in ["job.toml", "experiment.toml", "runs.csv"] {
        let text = std::fs::read(folder.path().join(name)).unwrap();
        std::fs::write(folder.path().join(name), &garbage).unwrap();
        let message = refusal(&path);
        assert!(message.starts_with(name), "{message}");
        assert!(message.contains("UTF-8"), "{message}");
        std::fs::remove_file(folder.path().join(name)).unwrap();
        let message = refusal(&path);
        assert!(
            message.starts_with(&format!("{name}: there is no such file")),
            "{message}"
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    }
}
