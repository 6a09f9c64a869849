//! Draw experiments whose truth is known, search them blind, and count.
//!
//! # Layout
//! - `kind`: what is hidden, and how one experiment is run. `laws`: what is in nobody's library.
//! - `design`: what the rig runs, and its files. `case`: a truth and its measurements.
//! - `pipeline`: the search, as the farm runs it. `clear`: what the data could say without noise. `held_out`: unseen runs.
//! - `fate`: how one experiment fared. `rate`: shares with their uncertainty. `targets`: the table.

pub(crate) mod case;
pub(crate) mod clear;
pub(crate) mod design;
pub(crate) mod fate;
mod held_out;
pub(crate) mod kind;
mod laws;
pub(crate) mod pipeline;
pub(crate) mod rate;
pub(crate) mod targets;

use std::sync::atomic::{AtomicU64, Ordering};

/// So many pieces of work on as many threads as the machine has, in their order; which thread does what changes nothing.
pub(crate) fn each<T: Send>(count: u64, work: impl Fn(u64) -> T + Sync) -> Result<Vec<T>, String> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicU64::new(0);
    let run = || {
        let mut done = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= count {
                return done;
            }
            done.push((number, work(number)));
        }
    };
    let parts = std::thread::scope(|scope| {
        let started: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        let joined = started.into_iter().map(|thread| thread.join());
        joined.collect::<Vec<_>>()
    });
    let mut all = Vec::new();
    for part in parts {
        all.extend(part.map_err(|_| "a thread panicked".to_owned())?);
    }
    all.sort_by_key(|(number, _)| *number);
    Ok(all.into_iter().map(|(_, made)| made).collect())
}
