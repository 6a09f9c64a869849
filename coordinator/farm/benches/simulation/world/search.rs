//! A search over many schedules on all cores for a broken promise.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::case::Case;
use super::plant::Plant;
use super::promise::Broken;
use super::schedule::{self, Journal};
use super::tally::Tally;

/// The result of a search.
#[derive(Debug)]
pub(crate) struct Search {
    /// The counts of the schedules that kept every promise.
    pub(crate) tally: Tally,
    /// The lowest seed found that breaks a promise.
    pub(crate) broken: Option<(u64, Broken)>,
    pub(crate) time: Duration,
}

/// Runs the schedules of some seeds on all cores, until a promise is broken or the time is over.
pub(crate) fn search(
    cases: &[Vec<Case>],
    plant: Option<Plant>,
    seeds: Range<u64>,
    max_time: Option<Duration>,
) -> Search {
    let began = Instant::now();
    let next = AtomicU64::new(seeds.start);
    let found: Mutex<(Tally, Option<(u64, Broken)>)> = Mutex::default();
    let work = || {
        let mut tally = Tally::default();
        let mut broken = None;
        while broken.is_none() {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end || max_time.is_some_and(|max_time| began.elapsed() > max_time) {
                break;
            }
            match schedule::run(cases, seed, plant, Journal(false)) {
                Ok(more) => tally += more,
                Err(how) => broken = Some((seed, how)),
            }
        }
        if broken.is_some() {
            // This ends the other threads, too.
            next.store(u64::MAX / 2, Ordering::Relaxed);
        }
        let mut found = found.lock().expect("no schedule panics while it is held");
        found.0 += tally;
        if let Some(broken) = broken
            && found.1.as_ref().is_none_or(|(seed, _)| broken.0 < *seed)
        {
            found.1 = Some(broken);
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    let (tally, broken) = found.into_inner().expect("no schedule panics");
    let time = began.elapsed();
    Search { tally, broken, time }
}
