//! Counts of the events in schedules.

use std::fmt;
use std::ops::AddAssign;

/// Counts of the events in schedules.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) schedules: u64,
    pub(crate) steps: u64,
    pub(crate) leases: u64,
    pub(crate) rows: u64,
    pub(crate) lost: u64,
    pub(crate) twice: u64,
    pub(crate) delayed: u64,
    pub(crate) crashes: u64,
    pub(crate) restores: u64,
    pub(crate) deaths: u64,
    pub(crate) stops: u64,
    pub(crate) jumps: u64,
    pub(crate) forged: u64,
    pub(crate) lies: u64,
    pub(crate) commands: u64,
    pub(crate) disputes: u64,
    pub(crate) confirmed: u64,
    pub(crate) quarantined: u64,
    pub(crate) finished: u64,
    pub(crate) cancelled: u64,
    pub(crate) given_up: u64,
}

impl Tally {
    fn counts(&self) -> [(&'static str, u64); 21] {
        [
            ("schedules", self.schedules),
            ("steps", self.steps),
            ("leases", self.leases),
            ("rows", self.rows),
            ("messages lost", self.lost),
            ("requests doubled", self.twice),
            ("messages delayed beyond a lease", self.delayed),
            ("coordinators killed", self.crashes),
            ("backups put back", self.restores),
            ("workers killed", self.deaths),
            ("workers stopped beyond a lease", self.stops),
            ("clock jumps", self.jumps),
            ("forged messages", self.forged),
            ("second, other answers", self.lies),
            ("commands of users", self.commands),
            ("disputes", self.disputes),
            ("rows confirmed by a second worker", self.confirmed),
            ("workers quarantined", self.quarantined),
            ("calibrations finished with the same bits", self.finished),
            ("calibrations cancelled", self.cancelled),
            (
                "schedules that end with an evaluation given up after faults on three workers",
                self.given_up,
            ),
        ]
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Tally) {
        self.schedules += other.schedules;
        self.steps += other.steps;
        self.leases += other.leases;
        self.rows += other.rows;
        self.lost += other.lost;
        self.twice += other.twice;
        self.delayed += other.delayed;
        self.crashes += other.crashes;
        self.restores += other.restores;
        self.deaths += other.deaths;
        self.stops += other.stops;
        self.jumps += other.jumps;
        self.forged += other.forged;
        self.lies += other.lies;
        self.commands += other.commands;
        self.disputes += other.disputes;
        self.confirmed += other.confirmed;
        self.quarantined += other.quarantined;
        self.finished += other.finished;
        self.cancelled += other.cancelled;
        self.given_up += other.given_up;
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.counts()
            .iter()
            .try_for_each(|(what, count)| writeln!(f, "{count:>14}  {what}"))
    }
}
