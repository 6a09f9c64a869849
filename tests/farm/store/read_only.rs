//! Reading a store in a folder that cannot be written.

use std::fs::{File, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::Path;
use std::process::Command;

use farm_tests::assert_contains;
use farm_tests::http::Client;
use farm_tests::job::Job;
use farm_tests::json::item_count;
use farm_tests::process::Process;
use farm_tests::programs::{coordinator, run, worker};
use farm_tests::service::{Service, free_address};
use farm_tests::wait::until;
use serde_json::json;
use tempfile::TempDir;

/// Returns a service with a finished calibration.
fn finished() -> Service {
    let service = Service::start(&["--local-workers", "2"]);
    service.calibrate(&Job::small());
    service
}

/// Sets the permissions of a file or a folder.
fn set_mode(path: &Path, mode: u32) {
    std::fs::set_permissions(path, Permissions::from_mode(mode)).expect("a mode is set");
}

/// A copy of a store and its log in a folder that its reader may not write to.
struct Closed(TempDir);

impl Closed {
    fn copy_of(service: &Service) -> Closed {
        let folder = tempfile::tempdir().expect("a folder");
        for end in ["", "-wal"] {
            let from = format!("{}{end}", service.store().display());
            let to = folder.path().join(format!("grouser.db{end}"));
            // A store without a log is complete. By default only its owner can read it.
            if std::fs::copy(from, &to).is_ok() {
                set_mode(&to, 0o644);
            }
        }
        let program = coordinator(["list"]).get_program().to_owned();
        std::fs::copy(program, folder.path().join("coordinator")).expect("the program is copied");
        set_mode(folder.path(), 0o555);
        Closed(folder)
    }

    /// Returns a command of the program. Permissions do not bind the superuser, so that the command switches to another
    /// user.
    fn command(&self, words: &[&str]) -> Command {
        let is_superuser =
            std::fs::metadata("/proc/self").is_ok_and(|process_folder| process_folder.uid() == 0);
        let program = self.0.path().join("coordinator");
        let mut command = match is_superuser {
            true => {
                let mut command = Command::new("setpriv");
                command
                    .args(["--reuid=65534", "--regid=65534", "--clear-groups"])
                    .arg(program);
                command
            }
            false => Command::new(program),
        };
        command.args(words);
        command
    }
}

impl Drop for Closed {
    fn drop(&mut self) {
        set_mode(self.0.path(), 0o755);
    }
}

/// `serve --read-only` that answers.
fn serving(command: impl FnOnce(&[&str]) -> Command, store: &Path, log: &Path) -> (Process, Client) {
    let client = Client(free_address());
    let store = format!("sqlite://{}", store.display());
    let words = ["serve", "--read-only", "--listen", &client.0, "--store", &store];
    let mut process = Process::start(command(&words), log);
    until("an answer of the reading service", || {
        assert!(process.is_running(), "{}", process.log());
        client.try_get("/health").ok().filter(|r| r.status == 200)
    });
    (process, client)
}

#[test]
fn a_folder_that_takes_no_file_can_be_read() {
    let mut service = finished();
    service.terminate();
    let closed = Closed::copy_of(&service);
    let folder = closed.0.path().display().to_string();
    for verb in ["list", "compare", "diagnose", "report", "export"] {
        let shown = run(closed.command(&[verb, "--out", &folder])).success();
        assert!(!shown.is_empty(), "{verb}");
    }
    let store = closed.0.path().join("grouser.db");
    let log = service.folder().join("reading.log");
    let (process, client) = serving(|words| closed.command(words), &store, &log);
    let report = client.get("/v1/calibrations/1/report");
    assert_eq!(report.status, 200, "{}\n{}", report.body, process.log());
}

#[test]
fn a_log_that_cannot_be_read_is_not_passed_over() {
    let mut service = Service::start(&[]);
    service.submit(&Job::small());
    service.kill();
    let closed = Closed::copy_of(&service);
    let folder = closed.0.path().display().to_string();
    let message = run(closed.command(&["list", "--out", &folder])).refusal();
    assert_contains!(message, "grouser.db-wal has what the file lacks");
}

#[test]
fn a_reading_service_shows_what_another_writes_and_takes_nothing() {
    let service = finished();
    let log = service.folder().join("reading.log");
    let (process, client) = serving(|words| coordinator(words), &service.store(), &log);
    let summary = "/v1/calibrations/1/summary";
    assert_eq!(client.json(summary), service.client.json(summary));
    let second = service.submit(&Job::small());
    assert_eq!(item_count(&client.json("/v1/calibrations")), 2);
    for path in [
        "/v1/experiments",
        "/v1/effects",
        "/v1/calibrations/2/pause",
        "/v1/work/exchange",
    ] {
        let refused = client.post(path, &json!({}));
        assert_eq!(refused.status, 403, "{path}");
        assert_contains!(refused.body, "--read-only");
    }
    assert_eq!(
        client
            .send("DELETE", "/v1/studies/1", None)
            .expect("an answer")
            .status,
        403
    );
    service.wait_for(second, "finished");
    assert_eq!(client.json("/v1/calibrations/2")["state"], "finished");
    drop(process);
}

#[test]
fn an_error_that_nobody_can_be_told_is_no_panic() {
    for mut command in [
        coordinator(["check", "there-is-no-job.toml"]),
        worker(["--coordinator", "there is no such URL"]),
    ] {
        let full = File::options().write(true).open("/dev/full");
        let ended = command.stderr(full.expect("a disk that is always full")).status();
        assert_eq!(ended.expect("the program starts").code(), Some(1), "{command:?}");
    }
}
