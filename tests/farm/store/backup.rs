//! `coordinator backup` of a store in use.

use std::path::{Path, PathBuf};

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{Ended, call};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until_true;

fn back_up(service: &Service, to: &Path) -> Ended {
    let store = service.store_name().to_owned();
    call("coordinator backup {} --store {}", &[&to, &store])
}

/// Returns the names in a folder, in order.
fn names(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    names.sort();
    names
}

#[test]
fn a_backup_under_work_is_one_moment_of_the_store_and_goes_on_to_the_same_bits() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = service.worker("worker", 2);
    until_true("some evaluations", || {
        service.evaluations(id).is_some_and(|done| done >= 60)
    });
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("grouser.db");
    let output = back_up(&service, &copy).success();
    assert_contains!(output, "MB, studies: 1, calibrations: 1");
    assert_eq!(names(folder.path()), std::slice::from_ref(&copy));
    service.wait_for(id, "finished");
    drop(worker);
    let posterior = |service: &Service| service.part(1, "posterior").body;
    let expected = posterior(&service);

    service.terminate();
    std::fs::copy(&copy, service.store()).expect("the backup is put back");
    service.restart();
    let worker = service.worker("again", 2);
    service.wait_for(id, "finished");
    drop(worker);
    same(&posterior(&service), &expected);
}

#[test]
fn nothing_is_overwritten_and_a_failed_backup_leaves_nothing() {
    let service = Service::start(&[]);
    let folder = tempfile::tempdir().expect("a folder");
    let taken = folder.path().join("taken.db");
    std::fs::write(&taken, "mine").expect("a file");
    let message = back_up(&service, &taken).refusal();
    assert_contains!(message, "taken.db: File exists");
    assert_eq!(std::fs::read_to_string(&taken).expect("a file"), "mine");
    let nowhere = folder.path().join("missing").join("copy.db");
    assert!(back_up(&service, &nowhere).refusal().contains("No such file"));
    let (half, other) = (
        folder.path().join("other.db.part"),
        folder.path().join("other.db"),
    );
    std::fs::write(&half, "mine").expect("a file");
    let message = back_up(&service, &other).refusal();
    assert_contains!(message, "other.db.part: File exists");
    assert_eq!(std::fs::read_to_string(&half).expect("a file"), "mine");
    assert_eq!(names(folder.path()), [half, taken]);
}
