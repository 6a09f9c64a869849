//! Builds the two programs once and runs them.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use serde_json::Value;
use tempfile::TempDir;

use crate::job::Job;
use crate::workspace::text;

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
    /// Returns the output of a program that must have succeeded.
    #[track_caller]
    pub fn success(self) -> String {
        assert_eq!(self.code, Some(0), "{}\n{}", self.stderr, self.stdout);
        self.stdout
    }

    /// Returns the message of a program that must have refused: the line behind `error: `, with what follows.
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

/// Returns a command of the program `coordinator`.
pub fn coordinator<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    command("coordinator".as_ref(), arguments)
}

/// Returns a command of the program `worker`.
pub fn worker<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    command("worker".as_ref(), arguments)
}

/// Runs a command line; see [`line()`].
pub fn call(template: &str, arguments: &[&dyn AsRef<OsStr>]) -> Ended {
    run(line(template, arguments))
}

/// Returns a command of `coordinator` or `worker` from a template of words, as `coordinator list --url {}`: each `{}` stands for the next
/// argument, which may contain blanks.
#[track_caller]
pub fn line(template: &str, arguments: &[&dyn AsRef<OsStr>]) -> Command {
    let mut arguments = arguments.iter();
    let mut words = template.split(' ').map(|word| {
        let mut parts = word.split("{}");
        let mut whole = OsString::from(parts.next().unwrap_or_default());
        for part in parts {
            whole.push(arguments.next().expect("an argument for each placeholder"));
            whole.push(part);
        }
        whole
    });
    let program = words.next().unwrap_or_default();
    let words: Vec<OsString> = words.collect();
    assert!(arguments.next().is_none(), "too many arguments for {template}");
    command(&program, words)
}

/// Runs a command to its end.
pub fn run(mut command: Command) -> Ended {
    let output = command.output().expect("the program starts");
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn command<S: AsRef<OsStr>>(name: &OsStr, arguments: impl IntoIterator<Item = S>) -> Command {
    let mut command = Command::new(built().join(name));
    command.args(arguments).stdin(Stdio::null()).env("NO_COLOR", "1");
    // The settings of the user's environment must not affect the tests.
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("GROUSER_") || name == "RUST_LOG" {
            command.env_remove(name);
        }
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

/// Returns the folder of the two programs, built on the first call with the profile of the running test.
fn built() -> &'static Path {
    static BUILT: OnceLock<Option<PathBuf>> = OnceLock::new();
    let built = BUILT.get_or_init(|| {
        let test = std::env::current_exe().expect("a running program has a path");
        // TARGET/PROFILE/deps/farm-HASH
        let folder = test.ancestors().nth(2).expect("tests stand in deps").to_owned();
        let target = folder
            .parent()
            .expect("a profile's folder lies in the target folder");
        let mut build = Command::new(env!("CARGO"));
        let words = "build --quiet -p coordinator -p worker -p fmu --target-dir";
        build.args(words.split(' ')).arg(target);
        if folder.ends_with("release") {
            build.arg("--release");
        }
        // With the variables that cargo sets for a test, the build script of ring would run again and cargo would rebuild its users.
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

/// A job that was calibrated by `coordinator run` in a folder of its own.
#[derive(Debug)]
pub struct Study {
    folder: TempDir,
    /// The standard output of the run.
    pub printed: String,
    /// `summary.json`.
    pub summary: Value,
}

impl Study {
    /// Runs a job in a fresh folder.
    #[track_caller]
    pub fn new(job: &Job) -> Study {
        let folder = tempfile::tempdir().expect("a folder");
        let path = job.write(&folder.path().join("job"));
        let out = folder.path().join("out");
        let printed = call("coordinator run {} --out {} --verbose", &[&path, &out]).success();
        assert!(out.join("report.html").exists());
        let summary = serde_json::from_str(&text(&out.join("summary.json")));
        let summary = summary.expect("JSON, in which every number is finite");
        Study {
            folder,
            printed,
            summary,
        }
    }

    /// Returns a file or folder below the output folder.
    pub fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join("out").join(name)
    }

    /// Returns the text of `posterior.csv`.
    #[track_caller]
    pub fn posterior(&self) -> String {
        text(&self.out("posterior.csv"))
    }
}

/// Runs a job in a fresh folder; returns the standard output of `coordinator run`, and the summary.
#[track_caller]
pub fn study(job: &Job) -> (String, Value) {
    let study = Study::new(job);
    (study.printed, study.summary)
}
