//! Damaged stores and stores of other versions are detected and reported at the start.

use std::fs::File;
use std::os::unix::fs::FileExt;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;

use super::serve;

#[test]
fn a_damaged_page_is_found_at_the_start_and_its_table_named() {
    let mut service = Service::start(&["--local-workers", "2"]);
    service.calibrate(&Job::small());
    service.terminate();
    let mut database = service.database();
    let page_size = database.number("PRAGMA page_size");
    let root = database.number("SELECT rootpage FROM sqlite_schema WHERE name = 'evaluations'");
    drop(database);
    let file = File::options()
        .write(true)
        .open(service.store())
        .expect("the store");
    let at = (root - 1) * page_size;
    file.write_all_at(&[0xa5; 64], at.unsigned_abs() + 8)
        .expect("damage");
    let message = serve(&service.store()).refusal();
    assert_contains!(
        message,
        "grouser.db",
        "damaged: table evaluations: ",
        "--read-only"
    );
}

#[test]
fn a_store_of_a_newer_version_says_so_by_numbers() {
    let mut service = Service::start(&[]);
    service.terminate();
    let mut database = service.database();
    let newest = database.number("SELECT max(version) FROM _sqlx_migrations");
    database.execute(
        "INSERT INTO _sqlx_migrations (version, description, success, checksum, execution_time)
         VALUES (900, 'later', 1, x'00', 0)",
    );
    drop(database);
    let newer = format!("version 900, this program knows versions up to {newest}");
    let message = serve(&service.store()).refusal();
    assert_contains!(message, newer);
    let folder = service.folder().display().to_string();
    let message = run(coordinator(["list", "--out", &folder])).refusal();
    assert_contains!(message, newer);
}
