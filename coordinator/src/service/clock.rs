//! The wall clock.

use std::time::{SystemTime, UNIX_EPOCH};

/// Wall-clock time. It is recorded, and no decision depends on it.
pub(super) fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}
