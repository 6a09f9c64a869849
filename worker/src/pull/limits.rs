//! The limits of a worker's service, and the reason of its end.

use std::time::{Duration, Instant};

/// The limits of a worker's service; without limits, it serves until it is asked to stop.
#[derive(Debug, Clone, Default)]
pub struct WorkerLimits {
    /// The worker ends after this time without a lease.
    pub max_idle: Option<Duration>,
    /// The worker ends at this time, before a queue ends it.
    pub ends_at: Option<Instant>,
    /// The worker ends when no calibration has wanted workers for some seconds.
    pub once: bool,
    /// The worker ends when its process uses more memory than this `[MB]`.
    pub max_memory_mb: Option<u64>,
}

/// Why a worker has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// The worker was asked to stop.
    Asked,
    /// The worker had no lease for [`WorkerLimits::max_idle`].
    Idle,
    /// The lifetime is over.
    Lifetime,
    /// No calibration wants workers.
    NothingLeft,
    /// The process exceeded its memory limit.
    Memory,
}

impl Ended {
    /// Returns the words for the log.
    pub fn words(self) -> &'static str {
        match self {
            Ended::Asked => "asked to stop",
            Ended::Idle => "idle for as long as --max-idle allows",
            Ended::Lifetime => "its lifetime is over",
            Ended::NothingLeft => "no calibration wants workers",
            Ended::Memory => "it holds more memory than --max-memory-mb allows",
        }
    }
}

impl WorkerLimits {
    /// Waits until the worker reaches a limit of time; `idle_since` is when it became idle, if it is.
    pub(super) fn reached(&self, idle_since: Option<Instant>) -> impl Future<Output = Ended> + use<> {
        let idle_until = idle_since.and_then(|since| Some(since + self.max_idle?));
        let ends_at = self.ends_at;
        let until = |time: Option<Instant>| async move {
            match time {
                Some(time) => tokio::time::sleep_until(time.into()).await,
                None => std::future::pending().await,
            }
        };
        let (idle, lifetime) = (until(idle_until), until(ends_at));
        async move {
            tokio::select! {
                biased;
                () = lifetime => Ended::Lifetime,
                () = idle => Ended::Idle,
            }
        }
    }

    /// Returns whether the process exceeds its memory limit; false if the system does not tell.
    pub(super) fn is_over_memory(&self) -> bool {
        let Some(max) = self.max_memory_mb else {
            return false;
        };
        resident_bytes().is_some_and(|held| held > max.saturating_mul(1_000_000))
    }
}

/// Returns the memory that this process holds `[bytes]`, from `/proc/self/status`, proc(5).
fn resident_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn the_limit_that_comes_first_is_the_reason() {
        let now = Instant::now();
        let limits = WorkerLimits {
            max_idle: Some(Duration::from_millis(1)),
            ends_at: Some(now + Duration::from_secs(3600)),
            ..WorkerLimits::default()
        };
        assert_eq!(limits.reached(Some(now)).await, Ended::Idle);
        let over = WorkerLimits {
            ends_at: Some(now),
            ..limits.clone()
        };
        assert_eq!(over.reached(Some(now)).await, Ended::Lifetime);
        let busy = tokio::time::timeout(Duration::from_millis(20), limits.reached(None));
        assert!(busy.await.is_err());
    }

    #[test]
    fn memory_is_measured_where_it_is_limited() {
        let limited = |max_memory_mb| WorkerLimits {
            max_memory_mb,
            ..WorkerLimits::default()
        };
        assert!(limited(Some(0)).is_over_memory());
        assert!(!limited(Some(1_000_000)).is_over_memory());
        assert!(!limited(None).is_over_memory());
    }
}
