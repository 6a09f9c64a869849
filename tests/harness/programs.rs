//! Builds the two programs once and runs them.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use serde_json::Value;

use crate::job::Job;

/// The exit code and the output of a program that has ended.
#[derive(Debug)]
pub struct Ended {
    /// Exit code; `None` where a signal ended it.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Ended {
    /// The output of a program that must have succeeded.
    ///
    /// # Panics
    /// It did not.
    #[track_caller]
    pub fn success(self) -> String {
        assert_eq!(self.code, Some(0), "{}\n{}", self.stderr, self.stdout);
        self.stdout
    }

    /// The message of a program that must have refused: the line behind `error: `, with what follows.
    ///
    /// # Panics
    /// It succeeded, died of a signal, panicked, or gave no message.
    #[track_caller]
    pub fn refusal(self) -> String {
        let Ended { code, stdout, stderr } = self;
        assert!(
            code.is_some_and(|c| c != 0),
            "exit code {code:?} where a refusal was due\n{stdout}\n{stderr}"
        );
        assert!(
            !stderr.contains("panicked") && !stderr.contains("RUST_BACKTRACE"),
            "panic:\n{stderr}"
        );
        let message = stderr
            .find("error: ")
            .map(|at| stderr[at + "error: ".len()..].trim().to_owned());
        message.unwrap_or_else(|| panic!("no message:\n{stderr}"))
    }
}

/// A command of the program `coordinator`.
pub fn coordinator<S: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    command("coordinator", arguments)
}

/// A command of the program `worker`.
pub fn worker<S: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    command("worker", arguments)
}

/// Runs a command to its end.
///
/// # Panics
/// The operating system refuses to start it.
pub fn run(mut command: Command) -> Ended {
    let output = command.output().expect("the program starts");
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn command<S: AsRef<std::ffi::OsStr>>(name: &str, arguments: impl IntoIterator<Item = S>) -> Command {
    let mut command = Command::new(built().join(name));
    command.args(arguments).stdin(Stdio::null()).env("NO_COLOR", "1");
    // settings of the user's environment must not affect the tests
    for variable in [
        "GROUSER_HOST",
        "GROUSER_LISTEN",
        "GROUSER_STORE",
        "GROUSER_LOCAL_WORKERS",
        "GROUSER_LEASE_MS",
        "GROUSER_URL",
        "GROUSER_COORDINATOR",
        "GROUSER_THREADS",
        "GROUSER_WIRE",
        "GROUSER_TOKEN",
        "GROUSER_CA_CERTIFICATE",
        "GROUSER_KEEP_DAYS",
        "GROUSER_TLS_CERTIFICATE",
        "GROUSER_TLS_KEY",
        "GROUSER_VERIFY_PERCENT",
        "GROUSER_WEBHOOK_HOST",
        "GROUSER_ALLOW_MODEL",
        "RUST_LOG",
    ] {
        command.env_remove(variable);
    }
    command
}

/// Limits the number of files and connections that the process of a command may have open.
pub fn with_descriptors(count: u32, command: &Command) -> Command {
    let mut limited = Command::new("sh");
    limited
        .args(["-c", &format!("ulimit -n {count} && exec \"$0\" \"$@\"")])
        .arg(command.get_program())
        .args(command.get_args())
        .stdin(Stdio::null());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => limited.env(name, value),
            None => limited.env_remove(name),
        };
    }
    limited
}

/// The folder of the two programs, built on the first call with the profile of the running test.
fn built() -> &'static Path {
    static BUILT: OnceLock<Option<PathBuf>> = OnceLock::new();
    let built = BUILT.get_or_init(|| {
        let test = std::env::current_exe().expect("a running program has a path");
        // TARGET/PROFILE/deps/farm-HASH
        let folder = test.ancestors().nth(2).expect("tests stand in deps").to_owned();
        let target = folder
            .parent()
            .expect("a profile's folder stands in the target folder");
        let mut build = Command::new(env!("CARGO"));
        build
            .args([
                "build",
                "--quiet",
                "-p",
                "coordinator",
                "-p",
                "worker",
                "--target-dir",
            ])
            .arg(target);
        if folder.ends_with("release") {
            build.arg("--release");
        }
        // The variables that cargo sets for a test would make the build script of ring run again, and rebuild all that use it.
        for (name, _) in std::env::vars_os() {
            let is_of_package = |prefix| name.to_string_lossy().starts_with(prefix);
            if is_of_package("CARGO_PKG_") || is_of_package("CARGO_MANIFEST_") {
                build.env_remove(name);
            }
        }
        let built = build
            .current_dir(crate::workspace::root())
            .status()
            .expect("cargo starts");
        built.success().then_some(folder)
    });
    built.as_deref().expect("the programs build")
}

/// Runs a job in a fresh folder: the text that `coordinator run` prints, and the summary.
///
/// # Panics
/// It fails, or writes no report.
#[track_caller]
pub fn study(job: &Job) -> (String, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out");
    let text = run(coordinator([
        "run",
        &path,
        "--out",
        &out.display().to_string(),
        "--verbose",
    ]))
    .success();
    assert!(out.join("report.html").exists());
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("summary.json");
    let summary = serde_json::from_str(&summary).expect("JSON, which has no form for what is no number");
    (text, summary)
}
