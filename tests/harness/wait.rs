//! Waiting with a deadline; no test sleeps for a fixed time instead.

use std::time::{Duration, Instant};

/// The longest wait for an event that should happen soon on a busy machine. On two idle cores the longest wait, for a program that is
/// held to its limits, takes half a minute.
const PATIENCE: Duration = Duration::from_secs(300);

/// Asks again and again until there is an answer; `what` says in a failure what was waited for.
#[track_caller]
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

/// Asks again and again until a condition holds.
#[track_caller]
pub fn until_true(what: &str, mut condition: impl FnMut() -> bool) {
    until(what, || condition().then_some(()));
}
