//! What happened, in numbers.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter, Result};
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::time::Duration;

use super::event::{FAULTS, Fault};
use crate::process::Process;

/// Counts of a soak.
#[derive(Debug, Default)]
pub struct Tally {
    /// Events of each fault.
    pub events: BTreeMap<Fault, u64>,
    /// Studies whose outcome had the bits of an undisturbed one, by job.
    pub compared: BTreeMap<&'static str, u64>,
    /// Pauses by reason; each was resumed.
    pub pauses: BTreeMap<String, u64>,
    /// How often the coordinator ended by itself, since its disk was full.
    pub ends_on_full_disk: u64,
    /// Counters of `/metrics`, over all starts of the coordinator; what came after the last look before a kill is missing.
    pub counters: BTreeMap<&'static str, Counter>,
    /// Longest time in which no calibration moved.
    pub longest_still: Duration,
    /// Longest time from SIGTERM to the end, by program.
    pub longest_stop: BTreeMap<&'static str, Duration>,
    /// Most memory `[kB]`, by program.
    pub most_kb: BTreeMap<&'static str, u64>,
    /// The first stop that was not orderly.
    pub disorderly: Option<String>,
    /// Whether the disk was a file system of its own, not a limit of the size of files.
    pub has_disk: bool,
    /// From the first event to the end.
    pub time: Duration,
}

/// A counter that begins again at zero with its program.
#[derive(Debug, Default, Clone, Copy)]
pub struct Counter {
    /// Over all starts.
    pub total: u64,
    last: u64,
}

/// The number of the signal that asks to stop.
const SIGTERM: i32 = 15;

/// The counters that are kept.
const COUNTERS: [(&str, &str); 7] = [
    ("grouser_leases_given_total", "leases given"),
    ("grouser_evaluations_completed_total", "results that counted"),
    ("grouser_evaluations_duplicate_total", "results that came twice"),
    ("grouser_evaluations_refused_total", "results refused"),
    ("grouser_leases_lost_total", "leases lost on the way"),
    ("grouser_leases_failed_total", "leases expired"),
    ("grouser_determinism_faults_total", "answers that differ"),
];

impl Tally {
    /// Takes the counters of a metrics page.
    pub(super) fn count(&mut self, page: &str) {
        for (name, _) in COUNTERS {
            let line = page
                .lines()
                .find_map(|line| line.strip_prefix(name)?.trim().parse().ok());
            let counter = self.counters.entry(name).or_default();
            let now = line.unwrap_or(counter.last);
            counter.total += now.checked_sub(counter.last).unwrap_or(now);
            counter.last = now;
        }
    }

    pub(super) fn note_stop(
        &mut self,
        program: &'static str,
        stopped: Option<(Duration, ExitStatus)>,
        is_excused: bool,
    ) {
        let Some((time, status)) = stopped else { return };
        let longest = self.longest_stop.entry(program).or_default();
        *longest = time.max(*longest);
        // The signal itself ends a program that has hardly started.
        let is_orderly =
            status.success() || status.signal() == Some(SIGTERM) || (is_excused && status.code() == Some(1));
        if !is_orderly {
            self.disorderly
                .get_or_insert_with(|| format!("a {program} was asked to stop: {status}"));
        }
    }

    pub(super) fn note_memory(&mut self, program: &'static str, process: Option<&Process>) {
        if let Some(kb) = process.and_then(|process| process.resident_kb()) {
            let most = self.most_kb.entry(program).or_default();
            *most = kb.max(*most);
        }
    }
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        writeln!(f, "{:>7}  event", "number")?;
        for (fault, words, _) in FAULTS {
            let number = self.events.get(&fault).copied().unwrap_or_default();
            writeln!(f, "{number:7}  {words}")?;
        }
        let events: u64 = self.events.values().sum();
        writeln!(f, "{events:7}  in all, {:.0} s", self.time.as_secs_f64())?;
        let disk = match self.has_disk {
            true => "a tmpfs of its own",
            false => "a limit of the size of files (RLIMIT_FSIZE)",
        };
        writeln!(
            f,
            "{:7}  times the coordinator ended on a full disk: {disk}",
            self.ends_on_full_disk
        )?;
        for (job, number) in &self.compared {
            writeln!(f, "{number:7}  studies {job} finished, compared and deleted")?;
        }
        for (counter, words) in COUNTERS {
            let total = self.counters.get(counter).map_or(0, |counter| counter.total);
            writeln!(f, "{total:7}  {words}")?;
        }
        writeln!(f, "{:7}  pauses", self.pauses.values().sum::<u64>())?;
        for (reason, number) in &self.pauses {
            writeln!(f, "{number:7}    {reason}")?;
        }
        writeln!(
            f,
            "{:7.1}  s without progress at most",
            self.longest_still.as_secs_f64()
        )?;
        for (program, time) in &self.longest_stop {
            writeln!(f, "{:7.1}  s to stop a {program} at most", time.as_secs_f64())?;
        }
        for (program, kb) in &self.most_kb {
            writeln!(f, "{:7.1}  MB in a {program} at most", *kb as f64 / 1e3)?;
        }
        Ok(())
    }
}
