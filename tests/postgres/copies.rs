//! Stores that move from a file to a server and back.

use farm_tests::assert_contains;
use farm_tests::database::Database;
use farm_tests::job::Job;
use farm_tests::programs::{call, coordinator, run};
use farm_tests::server::ServerDatabase;
use farm_tests::service::Service;
use farm_tests::workspace::{data, text};

/// Returns the rows of every table of a store in a file, with the bits of its numbers.
fn rows(store: &str) -> Vec<(String, String)> {
    let mut database = Database::open(store);
    let tables = database.text(
        "SELECT group_concat(name, ' ') FROM (SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE '\\_%' ESCAPE '\\'
         AND name NOT LIKE 'sqlite%' ORDER BY name)",
    );
    let mut rows = |table: &str| {
        let columns = format!(
            "SELECT group_concat('quote(' || name || ')', '||'',''||') FROM pragma_table_info('{table}')"
        );
        let columns = database.text(&columns);
        let sql = format!(
            "SELECT coalesce(group_concat(line, char(10)), '') FROM (SELECT {columns} AS line FROM {table} ORDER BY 1)"
        );
        (table.to_owned(), database.text(&sql))
    };
    tables.split(' ').map(&mut rows).collect()
}

/// Returns a finished study and one in progress, with a token, in a store of this run's kind.
fn filled() -> Service {
    let mut service = Service::start(&["--local-workers", "2"]);
    service.calibrate(&Job::small());
    service.client.get("/v1/studies/1/summary");
    let begun = service.submit(&Job::small());
    farm_tests::wait::until("some evaluations", || {
        service.evaluations(begun).filter(|&count| count >= 64)
    });
    call(
        "coordinator token add anna --role read --store {}",
        &[&service.store_name()],
    )
    .success();
    service.terminate();
    service
}

fn copy(from: &str, to: &str) -> String {
    run(coordinator(["copy-store", from, to])).success()
}

#[test]
fn a_store_goes_to_a_file_to_a_server_and_to_a_file_with_every_bit_and_goes_on_there() {
    let service = filled();
    let file = |name: &str| format!("sqlite://{}", service.folder().join(name).display());
    let (first, second) = (file("first.db"), file("second.db"));
    let output = copy(service.store_name(), &first);
    assert_contains!(output, "evaluations", "tables: 20\n");
    let server = ServerDatabase::new().expect("GROUSER_TEST_POSTGRES names a server");
    let there = copy(&first, &server.url());
    let table_lines = |output: &str| {
        output
            .lines()
            .filter(|line| !line.contains("tables:"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(table_lines(&output), table_lines(&there));
    copy(&server.url(), &second);
    assert_eq!(rows(&first), rows(&second));
    // Every copy has the finished study unchanged.
    let original = Service::start_on(service.store_name(), &["--read-only", "--insecure"]).posterior_csv(1);
    for copy in [&first, &server.url()] {
        let copied = Service::start_on(copy, &["--read-only", "--insecure"]).posterior_csv(1);
        assert_eq!(copied, original, "{copy}");
    }
    // A coordinator on either copy continues the unfinished study, and numbers new rows after the old ones.
    let posterior = |store: &str| {
        let service = Service::start_on(store, &["--local-workers", "2", "--insecure"]);
        service.wait_for(2, "finished");
        assert_eq!(service.submit(&Job::small()), 3);
        service.posterior_csv(2)
    };
    let expected = posterior(&server.url());
    assert_eq!(posterior(&second), expected);
    let ben = ["token", "add", "ben", "--role", "read", "--store", &server.url()];
    run(coordinator(ben)).success();
}

#[test]
fn a_store_of_an_old_version_goes_to_a_server_and_back_with_the_posterior_that_it_had() {
    let folder = tempfile::tempdir().expect("a folder");
    let store = |name: &str| format!("sqlite://{}", folder.path().join(name).display());
    std::fs::copy(data("store-8/finished.store"), folder.path().join("grouser.db"))
        .expect("the store is copied");
    // The service migrates the tables and leaves the rows unchanged.
    let posterior = |store: &str| {
        let mut service = Service::start_on(store, &["--insecure"]);
        let posterior = service.posterior_csv(1);
        service.terminate();
        posterior
    };
    let kept = text(&data("store-8/posterior.csv"));
    assert_eq!(posterior(&store("grouser.db")), kept);
    let server = ServerDatabase::new().expect("a server");
    copy(&store("grouser.db"), &server.url());
    assert_eq!(posterior(&server.url()), kept);
    copy(&server.url(), &store("back.db"));
    assert_eq!(posterior(&store("back.db")), kept);
}

#[test]
fn a_copy_needs_an_empty_place_of_the_other_kind() {
    let service = filled();
    let store = service.store_name();
    let file = format!("sqlite://{}", service.folder().join("copy.db").display());
    let refused = |from: &str, to: &str, reason: &str| {
        let refusal = run(coordinator(["copy-store", from, to])).refusal();
        assert_contains!(refusal, reason);
    };
    copy(store, &file);
    refused(store, &file, "has rows; a store is copied to an empty one");
    refused(&file, store, "has rows; a store is copied to an empty one");
    refused(store, store, "both are servers");
    refused(&file, &format!("{file}.2"), "both are files");
    refused(&format!("{file}.3"), store, "no such file");
    let blank = ServerDatabase::new().expect("a server");
    refused(&blank.url(), &format!("{file}.4"), "absent; coordinator serve");
}
