//! A finding of the doctor: the object of a check, its result, and a remedy.

use std::fmt;

/// The severity of a finding.
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
    /// Makes a finding without a problem.
    pub(super) fn ok(subject: &'static str, seen: impl Into<String>) -> Self {
        Finding {
            level: Level::Ok,
            subject,
            seen: seen.into(),
            remedy: None,
        }
    }

    /// Makes a finding about something that works with a limitation.
    pub(super) fn warn(subject: &'static str, seen: impl Into<String>, remedy: impl Into<String>) -> Self {
        Finding {
            level: Level::Warn,
            remedy: Some(remedy.into()),
            ..Finding::ok(subject, seen)
        }
    }

    /// Makes a finding about something that does not work.
    pub(super) fn fail(subject: &'static str, seen: impl Into<String>, remedy: impl Into<String>) -> Self {
        Finding {
            level: Level::Fail,
            ..Finding::warn(subject, seen, remedy)
        }
    }

    /// Returns whether the finding is a failure.
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
