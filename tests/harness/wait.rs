//! Waiting with a deadline; nothing sleeps in the hope that it was long enough.

use std::time::{Duration, Instant};

/// Patience for whatever should happen soon, on a machine that has other things to do: the longest wait, for a program that is held to
/// its limits, takes half a minute on two idle cores.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// Asks again and again until there is an answer.
///
/// # Panics
/// Nothing came within [`PATIENCE`]; `what` says what was waited for.
pub fn until<T>(what: &str, mut answer: impl FnMut() -> Option<T>) -> T {
    let deadline = Instant::now() + PATIENCE;
    loop {
        if let Some(answer) = answer() {
            return answer;
        }
        assert!(Instant::now() < deadline, "waited {PATIENCE:?} in vain: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
