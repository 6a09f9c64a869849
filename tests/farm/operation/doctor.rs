//! `coordinator doctor` on a sound machine, and with faults of store, address, token or workers.

use std::net::TcpListener;

use farm_tests::assert_contains;
use farm_tests::programs::{Ended, call, coordinator, run};
use farm_tests::service::Service;

/// Returns the doctor on a store and an address, with further arguments.
fn doctor(store: &str, listen: &str, more: &[&str]) -> Ended {
    let arguments = ["doctor", "--store", store, "--listen", listen];
    run(coordinator(arguments.iter().chain(more)))
}

/// Returns the line of a subject, and the remedy behind it.
#[track_caller]
fn line<'a>(text: &'a str, subject: &str) -> (&'a str, Option<&'a str>) {
    let mut lines = text.lines().peekable();
    let found = lines.find(|line| line.split_whitespace().nth(1) == Some(subject));
    let found = found.unwrap_or_else(|| panic!("nothing is said of {subject}:\n{text}"));
    let remedy = lines.peek().and_then(|next| next.trim().strip_prefix("-> "));
    (found, remedy)
}

#[test]
fn a_machine_without_a_store_is_well() {
    let folder = tempfile::tempdir().expect("a folder");
    let store = format!("sqlite://{}", folder.path().join("new.db").display());
    let ended = doctor(&store, "127.0.0.1:0", &[]);
    let text = ended.success();
    for subject in ["program", "processor", "clock", "store", "address"] {
        assert!(line(&text, subject).0.starts_with("ok "), "{text}");
    }
    assert!(!text.contains("fail"), "{text}");
    // The command leaves nothing behind.
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
}

#[test]
fn a_foreign_store_and_a_taken_address_fail_with_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("letters.db");
    std::fs::write(&file, "Dear store, you are none.").expect("a file");
    let taken = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = taken.local_addr().expect("an address").to_string();
    let ended = doctor(&file.display().to_string(), &address, &[]);
    assert_eq!(ended.code, Some(1));
    assert_contains!(ended.stderr, "error: 2 of 8 checks failed");
    let (store, remedy) = line(&ended.stdout, "store");
    assert!(store.starts_with("fail "), "{store}");
    assert!(store.contains("letters.db"), "{store}");
    assert!(remedy.is_some_and(|remedy| remedy.contains("backup")));
    let (seen, remedy) = line(&ended.stdout, "address");
    assert!(seen.starts_with("fail "), "{seen}");
    assert!(seen.contains("another program"), "{seen}");
    assert!(remedy.is_some_and(|remedy| remedy.contains("--listen")));
}

#[test]
fn a_service_is_asked_for_its_version_its_token_and_its_workers() {
    let service = Service::start(&[]);
    let store = service.store_name().to_owned();
    let seen = |more: &[&str]| {
        doctor(
            &store,
            &service.client.0,
            &[&["--url", &service.url()], more].concat(),
        )
    };
    let text = seen(&[]).success();
    assert!(
        line(&text, "address")
            .0
            .contains("in use by a coordinator of version"),
        "{text}"
    );
    let (workers, remedy) = line(&text, "workers");
    assert!(workers.starts_with("warn "), "{text}");
    assert!(
        remedy.is_some_and(|r| r.contains("worker --coordinator")),
        "{text}"
    );
    let worker = service.worker("one", 1);
    farm_tests::wait::until_true("a worker", || {
        seen(&[]).success().contains("1 in the last minute")
    });
    drop(worker);

    let file = service.folder().join("token");
    let added = call("coordinator token add reader --role read --store {}", &[&store]).success();
    std::fs::write(&file, added.trim()).expect("a file");
    farm_tests::wait::until_true("the token is asked for", || {
        service.client.get("/v1/studies").status == 401
    });
    let ended = seen(&[]);
    assert_eq!(ended.code, Some(1));
    let (token, remedy) = line(&ended.stdout, "token");
    assert!(token.starts_with("fail "), "{token}");
    assert!(remedy.is_some_and(|r| r.contains("token add")), "{token}");
    let text = seen(&["--token-file", &file.display().to_string()]).success();
    assert!(line(&text, "token").0.starts_with("ok "), "{text}");
}
