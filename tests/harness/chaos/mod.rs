//! Chaos: real programs, files and connections suffer faults, and studies must still end with the same bits.
//!
//! The events are a function of a seed and their numbers; their effects depend on the machine. Several faults may last at the same time.
//!
//! # Layout
//! - `event`: the faults, drawn at random.
//! - `farm`: coordinator, workers and backups, to which the events apply; `program` and `disk` are its parts.
//! - `user`: submits, compares and deletes studies; `outcome`: the results of a study as text.
//! - `tally`: counts of events and their consequences.

mod disk;
mod event;
mod farm;
mod outcome;
mod program;
mod tally;
mod user;

use std::time::{Duration, Instant};

use event::{Event, FAULTS};
use farm::Farm;
use outcome::Trouble;
pub use tally::Tally;
use user::User;

/// The number of events after which the farm may finish its studies.
const BLOCK: u64 = 100;
/// The time between two checks of the user.
const INTERVAL: Duration = Duration::from_millis(30);
/// The number of events that are reported with a broken promise.
const LAST: usize = 12;

/// Returns the names of all faults.
pub fn faults() -> impl Iterator<Item = &'static str> {
    FAULTS.iter().map(|(_, name, _)| *name)
}

/// Applies a number of events to a farm, and reports each one.
///
/// The farm may finish its studies after every hundred events. Returns the tally, and the promise that was broken, with the last events.
pub fn run(events: u64, seed: u64, mut report: impl FnMut(&str)) -> (Tally, Option<String>) {
    let farm = Farm::start();
    let user = User::new(farm.client.clone());
    let tally = Tally::default();
    let mut chaos = Chaos { farm, user, tally };
    let began = Instant::now();
    let mut lines: Vec<String> = Vec::new();
    let mut apply = || {
        for number in 1..=events {
            let event = Event::draw(seed, number);
            chaos.live(event.wait)?;
            let line = format!("{:8.2} s  {event}", began.elapsed().as_secs_f64());
            report(&line);
            lines.push(line);
            *chaos.tally.events.entry(event.name()).or_default() += 1;
            if chaos.farm.apply(&event) {
                chaos.user.expect_backup();
            }
            if number.is_multiple_of(BLOCK) || number == events {
                chaos.finish()?;
            }
        }
        chaos.farm.check_logs()
    };
    let done: Result<(), String> = apply();
    chaos.tally.note("s in all", began.elapsed().as_secs_f64());
    let broken = done.err().map(|promise| {
        let kept = chaos.farm.keep();
        format!(
            "seed {seed}, after event {}: {promise}\nlogs and store: {}\n{}",
            lines.len(),
            kept.display(),
            lines[lines.len().saturating_sub(LAST)..].join("\n")
        )
    });
    (chaos.tally, broken)
}

struct Chaos {
    farm: Farm,
    user: User,
    tally: Tally,
}

impl Chaos {
    /// Runs the farm for a time.
    fn live(&mut self, time: Duration) -> Result<(), String> {
        let end = Instant::now() + time;
        self.step(true)?;
        while Instant::now() < end {
            self.step(true)?;
        }
        self.farm.check_logs()
    }

    /// Empties the disk and runs the farm until its studies are finished.
    fn finish(&mut self) -> Result<(), String> {
        self.farm.empty_disk();
        while !self.user.is_done() {
            self.step(false)?;
        }
        Ok(())
    }

    /// Updates the farm, and lets its user act.
    fn step(&mut self, submits: bool) -> Result<(), String> {
        self.farm.update(&mut self.tally)?;
        if self.farm.answers() {
            match self.user.act(&mut self.tally, submits) {
                Ok(()) | Err(Trouble::Unreachable) => {}
                Err(Trouble::Failing(_)) if self.farm.may_fail() => {}
                Err(Trouble::Failing(message) | Trouble::Broken(message)) => return Err(message),
            }
        }
        std::thread::sleep(INTERVAL);
        Ok(())
    }
}
