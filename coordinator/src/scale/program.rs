//! The execution of an engine's program.

use std::io;
use std::process::{ExitStatus, Stdio};
use std::time::Duration;

use tokio::io::AsyncWriteExt as _;
use tokio::process::Command;

/// The time after which a silent program is terminated.
const PATIENCE: Duration = Duration::from_secs(60);

/// The reason why a call of an engine's program failed.
#[derive(Debug, thiserror::Error)]
pub enum ProgramError {
    /// The program cannot be started.
    #[error("{program}: cannot be run; is it installed, and in PATH?")]
    Run {
        program: &'static str,
        /// Reason given by the operating system.
        #[source]
        source: io::Error,
    },
    /// The program has not ended in time.
    #[error("{program}: no answer within {} s", PATIENCE.as_secs())]
    Silent { program: &'static str },
    /// The program has ended with an error.
    #[error("{program}: {status}: {answer}")]
    Failed {
        program: &'static str,
        status: ExitStatus,
        answer: String,
    },
    /// The program's answer does not have the form of the supported versions.
    #[error("{program}: unexpected answer {answer:?}")]
    Answer { program: &'static str, answer: String },
}

/// A call of a program, with its arguments, environment and input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Invocation {
    pub(super) program: &'static str,
    pub(super) arguments: Vec<String>,
    pub(super) environment: Vec<(&'static str, String)>,
    pub(super) input: String,
}

impl Invocation {
    pub(super) fn new(program: &'static str, arguments: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Invocation {
            program,
            arguments: arguments.into_iter().map(Into::into).collect(),
            environment: Vec::new(),
            input: String::new(),
        }
    }

    /// Runs the program. Returns its output.
    ///
    /// # Errors
    /// [`ProgramError`], but for [`ProgramError::Answer`].
    pub(super) async fn run(self) -> Result<String, ProgramError> {
        let program = self.program;
        let run = |source| ProgramError::Run { program, source };
        let mut child = Command::new(program)
            .args(self.arguments)
            .envs(self.environment)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .kill_on_drop(true)
            .spawn()
            .map_err(run)?;
        let stdin = child.stdin.take();
        let answer = async {
            if let Some(mut stdin) = stdin {
                // A program that reads no input may have closed it.
                let _ = stdin.write_all(self.input.as_bytes()).await;
            }
            child.wait_with_output().await
        };
        let output = tokio::time::timeout(PATIENCE, answer).await;
        let output = output
            .map_err(|_| ProgramError::Silent { program })?
            .map_err(run)?;
        if output.status.success() {
            return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
        }
        Err(ProgramError::Failed {
            program,
            status: output.status,
            answer: String::from_utf8_lossy(&output.stderr).trim().to_owned(),
        })
    }
}
