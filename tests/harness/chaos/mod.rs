//! Chaos: real programs, files and connections suffer faults, and studies must still end with the same bits.
//!
//! Events follow from a seed and their numbers; what they hit depends on the machine. Several may last at the same time.
//!
//! # Layout
//! - `event`: the faults, drawn at random.
//! - `farm`: coordinator, workers and backups, which suffer the events; `program`, `proxy`, `disk` are its parts.
//! - `user`: submits, compares, deletes; `outcome`: what a study gives, as text.
//! - `tally`: what happened, in numbers.

mod disk;
mod event;
mod farm;
mod outcome;
mod program;
mod proxy;
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
/// The time between two looks of the user.
const LOOK: Duration = Duration::from_millis(30);
/// The number of events that are told with a broken promise.
const LAST: usize = 12;

/// Every fault.
pub fn faults() -> impl Iterator<Item = &'static str> {
    FAULTS.iter().map(|(_, words, _)| *words)
}

/// Lets a number of events happen to a farm, and tells each as it happens.
///
/// The farm may finish its studies after every hundred events. Returns the tally, and the promise that was broken, with the last events.
pub fn soak(events: u64, seed: u64, mut tell: impl FnMut(&str)) -> (Tally, Option<String>) {
    let farm = Farm::start();
    let user = User::new(farm.client.clone());
    let tally = Tally::default();
    let mut soak = Soak { farm, user, tally };
    let began = Instant::now();
    let mut told: Vec<String> = Vec::new();
    let mut run = || {
        for number in 1..=events {
            let event = Event::draw(seed, number);
            soak.live(event.wait)?;
            let line = format!("{:8.2} s  {event}", began.elapsed().as_secs_f64());
            tell(&line);
            told.push(line);
            *soak.tally.events.entry(event.words()).or_default() += 1;
            if soak.farm.suffer(&event) {
                soak.user.expect_a_backup();
            }
            if number.is_multiple_of(BLOCK) || number == events {
                soak.finish()?;
            }
        }
        soak.farm.check_logs()
    };
    let done: Result<(), String> = run();
    soak.tally.note("s in all", began.elapsed().as_secs_f64());
    let broken = done.err().map(|promise| {
        let kept = soak.farm.keep();
        format!(
            "seed {seed}, after event {}: {promise}\nlogs and store: {}\n{}",
            told.len(),
            kept.display(),
            told[told.len().saturating_sub(LAST)..].join("\n")
        )
    });
    (soak.tally, broken)
}

struct Soak {
    farm: Farm,
    user: User,
    tally: Tally,
}

impl Soak {
    /// Goes on for a time.
    fn live(&mut self, time: Duration) -> Result<(), String> {
        let end = Instant::now() + time;
        self.step(true)?;
        while Instant::now() < end {
            self.step(true)?;
        }
        self.farm.check_logs()
    }

    /// Heals the farm and lets it finish its studies.
    fn finish(&mut self) -> Result<(), String> {
        self.farm.heal();
        while !self.user.is_done() {
            self.step(false)?;
        }
        Ok(())
    }

    /// Tends the farm, and lets its user look.
    fn step(&mut self, submits: bool) -> Result<(), String> {
        self.farm.tend(&mut self.tally)?;
        if self.farm.answers() {
            match self.user.look(&mut self.tally, submits) {
                Ok(()) | Err(Trouble::Away) => {}
                Err(Trouble::Failing(_)) if self.farm.is_excused() => {}
                Err(Trouble::Failing(message) | Trouble::Broken(message)) => return Err(message),
            }
        }
        std::thread::sleep(LOOK);
        Ok(())
    }
}
