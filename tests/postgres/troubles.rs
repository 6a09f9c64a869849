//! A server that goes away, and databases that are no store.

use farm_tests::assert_contains;
use farm_tests::database::Database;
use farm_tests::job::Job;
use farm_tests::programs::{call, coordinator, run};
use farm_tests::server::ServerDatabase;
use farm_tests::service::Service;
use farm_tests::wait::until;

#[test]
fn a_coordinator_that_loses_its_connection_ends_with_the_reason_and_another_goes_on_with_the_same_bits() {
    let mut service = Service::start(&["--local-workers", "2"]);
    let first = service.calibrate(&Job::small());
    let expected = service.posterior_csv(first);
    let second = service.submit(&Job::small());
    until("some evaluations", || {
        service.evaluations(second).filter(|&done| done >= 64)
    });
    service.server_database().end_connections();
    assert!(!service.wait());
    let log = service.log();
    assert_contains!(log, "the store can no longer be written");
    service.restart();
    service.wait_for(second, "finished");
    assert_eq!(service.posterior_csv(second), expected);
}

#[test]
fn an_idle_coordinator_that_loses_its_connection_ends_too() {
    let mut service = Service::start(&[]);
    service.server_database().end_connections();
    assert!(!service.wait());
    let log = service.log();
    assert_contains!(log, "the store can no longer be written");
}

#[test]
fn a_database_of_others_and_one_of_a_later_version_are_refused_and_left_alone() {
    let database = ServerDatabase::new().expect("GROUSER_TEST_POSTGRES names a server");
    let url = database.url();
    let serve = || run(coordinator(["serve", "--listen", "127.0.0.1:0", "--store", &url])).refusal();
    Database::open(&url).execute("CREATE TABLE rigs (name TEXT)");
    assert!(serve().ends_with("the database has tables that Grouser did not create"));
    assert_eq!(
        Database::open(&url)
            .number("SELECT count(*) FROM information_schema.tables WHERE table_schema = 'public'"),
        1
    );
    let mut service = Service::start(&[]);
    service.terminate();
    service
        .database()
        .execute("UPDATE _sqlx_migrations SET version = 900 WHERE version = 19");
    let words = [
        "serve",
        "--listen",
        "127.0.0.1:0",
        "--store",
        service.store_name(),
    ];
    let refusal = run(coordinator(words)).refusal();
    assert_contains!(refusal, "tables have version 900");
}

#[test]
fn the_doctor_and_backup_say_what_to_do_with_a_server() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let doctor = |store: &str| call("coordinator doctor --listen 127.0.0.1:0 --store {}", &[&store]);
    let output = doctor(service.store_name()).success();
    assert_contains!(output, "ok    store       postgres://", ": 1 calibrations");
    let blank = ServerDatabase::new().expect("a server");
    let output = doctor(&blank.url()).success();
    assert_contains!(output, "has no tables yet; serve makes them");
    let absent = "postgres://nobody:secret@127.0.0.1:1/none";
    let ended = doctor(absent);
    assert!(ended.stdout.contains("start the server"), "{}", ended.stdout);
    assert!(!ended.stdout.contains("secret"), "{}", ended.stdout);
    let file = service.folder().join("copy.db").display().to_string();
    let refusal = run(coordinator(["backup", &file, "--store", service.store_name()])).refusal();
    assert_contains!(refusal, "pg_dump", "copy-store");
}
