//! Independent pieces of work on all threads of the machine.

use std::sync::atomic::{AtomicU64, Ordering};

use super::error::StudyError;

/// Returns the number of threads of the machine.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Returns the results of pieces of work, in their order, which does not depend on the threads; the first error ends all.
pub fn each<T, E>(count: u64, work: impl Fn(u64) -> Result<T, E> + Sync) -> Result<Vec<T>, StudyError>
where
    T: Send,
    E: Into<StudyError> + Send,
{
    let results = each_on(threads(), count, work)?.into_iter();
    results.map(|result| result.map_err(Into::into)).collect()
}

/// Returns the results of pieces of work on a number of threads, in their order, which does not depend on the threads.
pub fn each_on<T: Send>(
    threads: usize,
    count: u64,
    work: impl Fn(u64) -> T + Sync,
) -> Result<Vec<T>, StudyError> {
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
        all.extend(part.map_err(|_| "a thread panicked")?);
    }
    all.sort_by_key(|(number, _)| *number);
    Ok(all.into_iter().map(|(_, made)| made).collect())
}
