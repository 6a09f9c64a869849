//! Checks of the machine: program, processor, clock, file descriptors.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rustix::process::{Resource, getrlimit};

use super::finding::Finding;
use crate::config::ARCHITECTURE;
use crate::embedded::model_version;

/// The beginning of 2026. A clock that shows an earlier time is wrong.
const EARLIEST: Duration = Duration::from_secs(1_767_225_600);
/// File descriptors that a service needs for its connections and its store.
const DESCRIPTORS: u64 = 4_096 + 64;

pub(super) fn findings() -> Vec<Finding> {
    vec![
        Finding::ok(
            "program",
            format!(
                "coordinator {}, equations {}",
                env!("CARGO_PKG_VERSION"),
                model_version()
            ),
        ),
        processor(),
        clock(SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()),
        descriptors(getrlimit(Resource::Nofile).maximum),
    ]
}

/// Reports the needed features of the processor; a processor that lacks one is refused before any command.
fn processor() -> Finding {
    let needed = if cfg!(target_feature = "avx2") {
        " with avx2"
    } else {
        ""
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Finding::ok(
        "processor",
        format!("{ARCHITECTURE}{needed}, as the build needs; {threads} at a time"),
    )
}

/// Checks the clock: store and log contain its times.
fn clock(since_1970: Duration) -> Finding {
    if since_1970 >= EARLIEST {
        return Finding::ok("clock", "after the beginning of 2026");
    }
    let days = (EARLIEST - since_1970).as_secs() / 86_400;
    Finding::fail(
        "clock",
        format!("{days} days before 2026"),
        "set it, as by systemctl enable --now systemd-timesyncd: times of studies and of certificates are read from it",
    )
}

/// Checks the largest number of open files that a service may allow itself; `None` where there is no limit.
fn descriptors(max_files: Option<u64>) -> Finding {
    match max_files {
        Some(max_files) if max_files < DESCRIPTORS => Finding::warn(
            "files",
            format!(
                "at most {max_files} are open at once: a service takes fewer connections than its {DESCRIPTORS} need"
            ),
            format!("ulimit -n {DESCRIPTORS}, or LimitNOFILE in its unit"),
        ),
        Some(max_files) => Finding::ok("files", format!("at most {max_files} are open at once")),
        None => Finding::ok("files", "as many are open at once as there may be"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_before_the_program_and_few_descriptors_are_named() {
        let text = clock(EARLIEST - Duration::from_secs(3 * 86_400)).to_string();
        assert!(
            text.starts_with("fail  clock       3 days before 2026\n"),
            "{text}"
        );
        assert!(!clock(EARLIEST).is_failure());
        let text = descriptors(Some(1024)).to_string();
        assert!(
            text.starts_with("warn  files       at most 1024") && text.contains("LimitNOFILE"),
            "{text}"
        );
        assert!(descriptors(Some(DESCRIPTORS)).to_string().starts_with("ok"));
    }
}
