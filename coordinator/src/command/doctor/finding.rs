//! A line of the answer: the object of a check, its result, and a remedy.

use std::fmt;

/// How serious it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Level {
    Ok,
    Warn,
    Fail,
}

/// The result of a check.
#[derive(Debug)]
pub(super) struct Finding {
    level: Level,
    subject: &'static str,
    seen: String,
    remedy: Option<String>,
}

impl Finding {
    /// All is well.
    pub(super) fn ok(subject: &'static str, seen: impl Into<String>) -> Self {
        Finding {
            level: Level::Ok,
            subject,
            seen: seen.into(),
            remedy: None,
        }
    }

    /// It works, but not as well as it should.
    pub(super) fn warn(subject: &'static str, seen: impl Into<String>, remedy: impl Into<String>) -> Self {
        Finding {
            level: Level::Warn,
            remedy: Some(remedy.into()),
            ..Finding::ok(subject, seen)
        }
    }

    /// It does not work.
    pub(super) fn fail(subject: &'static str, seen: impl Into<String>, remedy: impl Into<String>) -> Self {
        Finding {
            level: Level::Fail,
            ..Finding::warn(subject, seen, remedy)
        }
    }

    /// Whether it does not work.
    pub(super) fn is_failure(&self) -> bool {
        self.level == Level::Fail
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = match self.level {
            Level::Ok => "ok",
            Level::Warn => "warn",
            Level::Fail => "fail",
        };
        writeln!(f, "{level:<5} {:<11} {}", self.subject, self.seen)?;
        match &self.remedy {
            Some(remedy) => writeln!(f, "{:<17} -> {remedy}", ""),
            None => Ok(()),
        }
    }
}
