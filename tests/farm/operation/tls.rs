//! TLS by the service itself: worker and verbs through it, and what is refused.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::time::Duration;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::process::Process;
use farm_tests::programs::{Ended, call, coordinator, run, worker};
use farm_tests::service::free_address;
use farm_tests::wait::until_true;
use farm_tests::workspace::data;
use tempfile::TempDir;

/// Returns a file of the tests' certificates, which are those of `localhost` and 127.0.0.1 under an authority of their
/// own.
fn pem(name: &str) -> String {
    data("tls").join(name).display().to_string()
}

/// A service with the tests' certificate.
struct Encrypted {
    folder: TempDir,
    address: String,
    process: Process,
}

impl Encrypted {
    fn start() -> Encrypted {
        let folder = tempfile::tempdir().expect("a folder");
        let address = free_address();
        let store = format!("sqlite://{}", folder.path().join("grouser.db").display());
        let (certificate, key) = (pem("certificate.pem"), pem("key.pem"));
        let mut words = vec!["serve", "--listen", &address, "--store", &store];
        words.extend(["--tls-certificate", &certificate, "--tls-key", &key]);
        let mut process = Process::start(coordinator(words), &folder.path().join("log"));
        until_true("the service", || {
            assert!(process.is_running(), "{}", process.log());
            process.log().contains("serving")
        });
        Encrypted {
            folder,
            address,
            process,
        }
    }

    fn url(&self) -> String {
        format!("https://{}", self.address)
    }

    /// Returns a verb that trusts the tests' authority.
    fn verb(&self, words: &[&str]) -> Ended {
        let (url, authority) = (self.url(), pem("authority.pem"));
        run(coordinator(
            [words, &["--url", &url, "--ca-certificate", &authority]].concat(),
        ))
    }
}

#[test]
fn a_calibration_runs_through_tls_and_ends_as_it_does_without() {
    let service = Encrypted::start();
    let job = Job::small()
        .write(&service.folder.path().join("job"))
        .display()
        .to_string();
    service.verb(&["submit", &job]).success();
    let port = service.address.rsplit(':').next().expect("a port");
    let named = format!("https://localhost:{port}");
    let authority = pem("authority.pem");
    let words = [
        "--coordinator",
        &named,
        "--threads",
        "2",
        "--ca-certificate",
        &authority,
    ];
    let log = service.folder.path().join("worker.log");
    let working = Process::start(worker(words), &log);
    until_true("the end of the calibration", || {
        service.verb(&["list"]).success().contains("finished")
    });
    drop(working);
    let out: PathBuf = service.folder.path().join("out");
    run(coordinator(["run", &job, "--out", &out.display().to_string()])).success();
    let plain = std::fs::read_to_string(out.join("posterior.csv")).expect("a posterior");
    assert_eq!(service.verb(&["export", "1"]).success(), plain);
}

#[test]
fn an_unknown_authority_plain_http_and_silence_are_refused() {
    let mut service = Encrypted::start();
    let refused = run(coordinator(["list", "--url", &service.url()])).refusal();
    assert_contains!(refused, "certificate");
    let mut plain = TcpStream::connect(&service.address).expect("a connection");
    plain
        .write_all(b"GET /health HTTP/1.0\r\n\r\n")
        .expect("a request");
    let mut answer = Vec::new();
    let _ = plain.read_to_end(&mut answer);
    assert!(
        !answer.starts_with(b"HTTP"),
        "{}",
        String::from_utf8_lossy(&answer)
    );
    let mut silent = TcpStream::connect(&service.address).expect("a connection");
    service.verb(&["list"]).success();
    silent
        .set_read_timeout(Some(Duration::from_secs(60)))
        .expect("a time limit");
    assert_eq!(silent.read(&mut [0; 16]).expect("the service hangs up"), 0);
    assert!(service.process.is_running());
}

#[test]
fn files_that_are_no_certificate_and_no_key_are_named() {
    let serve = |certificate: &str, key: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        let store = format!("sqlite://{}", folder.path().join("grouser.db").display());
        let mut command = coordinator(["serve", "--listen", &free_address(), "--store", &store]);
        command.args(["--tls-certificate", certificate, "--tls-key", key]);
        run(command).refusal()
    };
    let (certificate, key) = (pem("certificate.pem"), pem("key.pem"));
    let message = serve("/nowhere.pem", &key);
    assert!(
        message.starts_with("/nowhere.pem: no certificate in PEM form"),
        "{message}"
    );
    let message = serve(&certificate, &certificate);
    assert_contains!(message, "certificate.pem: no private key in PEM form");
    let message = serve(&pem("authority.pem"), &key);
    assert_contains!(message, "authority.pem with key");
    let listed = call(
        "coordinator list --url https://127.0.0.1:1 --ca-certificate {}",
        &[&key],
    )
    .refusal();
    assert_contains!(listed, "key.pem: no certificate in PEM form");
    let worked = call(
        "worker --coordinator https://127.0.0.1:1 --ca-certificate {}",
        &[&key],
    )
    .refusal();
    assert_contains!(worked, "key.pem: none in PEM form");
    let command = coordinator(["serve", "--tls-certificate", &certificate]);
    assert!(run(command).refusal().contains("--tls-key"));
}
