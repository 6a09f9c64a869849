//! Counts of the events in schedules.

use std::fmt;
use std::ops::AddAssign;

/// Defines the counts with their labels.
macro_rules! tally {
    ($($count:ident: $label:literal,)+) => {
        /// Counts of the events in schedules.
        #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
        pub(crate) struct Tally {
            $(pub(crate) $count: u64,)+
        }

        impl AddAssign for Tally {
            fn add_assign(&mut self, other: Tally) {
                $(self.$count += other.$count;)+
            }
        }

        impl fmt::Display for Tally {
            fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                $(writeln!(f, "{:>14}  {}", self.$count, $label)?;)+
                Ok(())
            }
        }
    };
}

tally! {
    schedules: "schedules",
    steps: "steps",
    leases: "leases",
    rows: "rows",
    lost: "messages lost",
    twice: "requests doubled",
    delayed: "messages delayed beyond a lease",
    crashes: "coordinators killed",
    restores: "backups put back",
    deaths: "workers killed",
    stops: "workers stopped beyond a lease",
    jumps: "clock jumps",
    forged: "forged messages",
    lies: "second, other answers",
    commands: "commands of users",
    disputes: "disputes",
    confirmed: "rows confirmed by a second worker",
    quarantined: "workers quarantined",
    finished: "calibrations finished with the same bits",
    cancelled: "calibrations cancelled",
    given_up: "schedules that end with an evaluation given up after faults on three workers",
}
