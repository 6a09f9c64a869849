//! Chaos: real programs, files and connections, to which everything happens that may, while studies must end with the same bits.
//!
//! Events follow from a seed and their numbers; what they hit depends on the machine. Several may last at the same time.
//!
//! # Layout
//! - `event`: what happens, drawn.
//! - `farm`: coordinator, workers, backups; lets events happen.
//! - `program`, `proxy`, `network`, `disk`, `backups`: what is killed and halted, cut, filled, and put back.
//! - `job`, `outcome`: what the farm works on, and what must come of it.
//! - `user`: submits, compares, deletes; `acknowledged`: what it was told; `trouble`: what is in its way.
//! - `tally`: what happened, in numbers.

mod acknowledged;
mod backups;
mod disk;
mod event;
mod farm;
mod job;
mod network;
mod outcome;
mod program;
mod proxy;
mod tally;
mod trouble;
mod user;

use std::time::{Duration, Instant};

pub use event::Fault;
use event::{Event, FAULTS};
use farm::Farm;
pub use tally::{Counter, Tally};
use trouble::Trouble;
use user::User;

/// After so many events the farm may finish what it has.
const BLOCK: u64 = 100;
/// The user looks again after.
const LOOK: Duration = Duration::from_millis(30);
/// Without progress for so long a farm stands still.
const PATIENCE: Duration = Duration::from_secs(300);
/// So many events before a broken promise are told with it.
const LAST: usize = 12;
/// Most memory of a program `[kB]`.
const MOST_KB: u64 = 300_000;

/// Every fault.
pub fn faults() -> impl Iterator<Item = Fault> {
    FAULTS.iter().map(|(fault, ..)| *fault)
}

/// Lets so many events happen to a farm, which may finish what it has after every hundred of them, and tells each as it happens; what
/// happened, and the promise that was broken, with the last events.
pub fn soak(events: u64, seed: u64, mut tell: impl FnMut(&str)) -> (Tally, Option<String>) {
    let references = job::references();
    let mut farm = Farm::start();
    let user = User::new(farm.client.clone(), references);
    let tally = Tally {
        has_disk: farm.has_disk(),
        ..Tally::default()
    };
    let mut soak = Soak { user, tally };
    let began = Instant::now();
    let mut told: Vec<String> = Vec::new();
    let mut run = || {
        for number in 1..=events {
            let event = Event::draw(seed, number);
            soak.live(&mut farm, event.wait)?;
            farm.check_logs()?;
            let line = format!("{:8.2} s  {event}", began.elapsed().as_secs_f64());
            tell(&line);
            told.push(line);
            *soak.tally.events.entry(event.fault).or_default() += 1;
            if farm.suffer(&event, &mut soak.tally) {
                soak.user.acknowledged.expect_a_backup();
            }
            if number.is_multiple_of(BLOCK) || number == events {
                soak.finish(&mut farm)?;
            }
        }
        farm.check_logs()
    };
    let done: Result<(), String> = run();
    soak.tally.time = began.elapsed();
    let broken = done.err().map(|promise| {
        let kept = farm.keep();
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
    user: User,
    tally: Tally,
}

impl Soak {
    /// Goes on for a time.
    fn live(&mut self, farm: &mut Farm, time: Duration) -> Result<(), String> {
        let end = Instant::now() + time;
        self.step(farm, true)?;
        while Instant::now() < end {
            std::thread::sleep(LOOK);
            self.step(farm, true)?;
        }
        Ok(())
    }

    /// Heals the farm and lets it finish what it has.
    fn finish(&mut self, farm: &mut Farm) -> Result<(), String> {
        farm.heal();
        while !self.user.acknowledged.is_empty() {
            self.step(farm, false)?;
            std::thread::sleep(LOOK);
        }
        Ok(())
    }

    /// Tends the farm, and lets its user look.
    fn step(&mut self, farm: &mut Farm, submits: bool) -> Result<(), String> {
        farm.tend(&mut self.tally)?;
        if farm.answers() {
            match self.user.look(&mut self.tally, submits) {
                Ok(()) | Err(Trouble::Away) => {}
                Err(Trouble::Failing(_)) if farm.is_excused() => {}
                Err(Trouble::Failing(message) | Trouble::Broken(message)) => return Err(message),
            }
            if let Ok(page) = farm.client.try_get("/metrics") {
                self.tally.count(&page.body);
            }
        }
        self.check()
    }

    fn check(&self) -> Result<(), String> {
        let tally = &self.tally;
        if let Some(stop) = &tally.disorderly {
            return Err(stop.clone());
        }
        if let Some((program, kb)) = tally.most_kb.iter().find(|(_, kb)| **kb > MOST_KB) {
            return Err(format!("a {program} holds {kb} kB"));
        }
        let disputes = tally.counters.get("grouser_determinism_faults_total");
        if disputes.is_some_and(|counter| counter.total > 0) {
            return Err("two answers to one evaluation differ".into());
        }
        match tally.longest_still > PATIENCE {
            true => Err(format!("no progress for {:?}", tally.longest_still)),
            false => Ok(()),
        }
    }
}
