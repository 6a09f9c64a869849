//! One coordinator for each file under any name, and waiting for the locks of other programs.

use std::os::unix::fs::{MetadataExt, symlink};
use std::time::Duration;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::service::Service;
use farm_tests::wait::until_true;

use super::serve;

#[test]
fn a_symlink_to_a_store_in_use_starts_no_second_coordinator() {
    let service = Service::start(&[]);
    let other = tempfile::tempdir().expect("a folder");
    let link = other.path().join("link.db");
    symlink(service.store(), &link).expect("a symlink");
    let folder = other.path().join("folder");
    symlink(service.folder(), &folder).expect("a symlink");
    for name in [link, folder.join("grouser.db")] {
        let message = serve(&name).refusal();
        assert_contains!(message, "another coordinator is using this file");
    }
}

#[test]
fn a_new_store_is_its_owners_alone() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    for end in ["", "-wal", "-shm", ".lock"] {
        let file = format!("{}{end}", service.store().display());
        let mode = std::fs::metadata(&file).expect("a file of the store").mode();
        assert_eq!(mode & 0o777, 0o600, "{file}: {mode:o}");
    }
}

#[test]
fn a_store_with_two_names_is_refused_before_it_loses_its_write_ahead_log() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let link = service.folder().join("hard.db");
    std::fs::hard_link(service.store(), &link).expect("a hard link");
    let message = serve(&link).refusal();
    assert_contains!(message, "hard.db: the file has 2 names");
    assert!(!service.folder().join("hard.db-wal").exists());
}

#[test]
fn a_foreign_lock_is_waited_for_and_nothing_is_lost() {
    let mut service = Service::start(&[]);
    let mut foreign = service.database();
    foreign.execute("BEGIN IMMEDIATE");
    std::thread::scope(|scope| {
        let submitted = scope.spawn(|| service.submit(&Job::small()));
        until_true("a word about the lock", || {
            service.log().contains("another program holds a lock")
        });
        assert_eq!(service.client.get("/health").status, 200);
        foreign.execute("COMMIT");
        assert_eq!(submitted.join().expect("an answer"), 1);
    });
    // The service can be stopped while the store is locked, and the next start reports the lock.
    foreign.execute("BEGIN IMMEDIATE");
    assert!(service.terminate());
    let message = serve(&service.store()).refusal();
    assert_contains!(message, "another program holds a lock");
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_secs(1));
            foreign.execute("COMMIT");
        });
        service.restart();
    });
    assert_eq!(service.status(1)["state"], "queued");
}
