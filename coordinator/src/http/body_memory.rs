//! The memory for all bodies that are being received or read.
//!
//! Workers' messages, other ordinary bodies and large bodies have separate memory. Thus a client that sends large or incomplete bodies
//! cannot keep workers from posting results. A worker posts its results as soon as the previous answer has arrived: about 2 kB for an
//! evaluation of 24 runs, 200 kB for a hundred of them. 320 such messages fit at the same time, and each is there for milliseconds.

use std::sync::Arc;
use std::time::Duration;

use axum::body::Bytes;
use shared::api::ErrorKind;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::error::HttpError;

/// The largest ordinary body `[bytes]`.
pub(super) const ORDINARY: usize = 4 << 20;
/// Memory for all ordinary bodies of workers together `[bytes]`.
const OF_WORKERS_TOGETHER: usize = 64 << 20;
/// Memory for all other ordinary bodies together `[bytes]`.
const ORDINARY_TOGETHER: usize = 32 << 20;
/// Memory for all large bodies together: two of the largest `[bytes]`.
const LARGE_TOGETHER: usize = 128 << 20;
/// The time that a body waits for memory before it is refused.
const PATIENCE: Duration = Duration::from_secs(5);

/// The memory of all bodies; clones share it.
#[derive(Debug, Clone)]
pub(super) struct BodyMemory {
    of_workers: Arc<Semaphore>,
    ordinary: Arc<Semaphore>,
    large: Arc<Semaphore>,
}

impl BodyMemory {
    pub(super) fn new() -> Self {
        BodyMemory {
            of_workers: Arc::new(Semaphore::new(OF_WORKERS_TOGETHER)),
            ordinary: Arc::new(Semaphore::new(ORDINARY_TOGETHER)),
            large: Arc::new(Semaphore::new(LARGE_TOGETHER)),
        }
    }

    /// Reserves memory for a body of `bytes`, which is at most the largest size of any route.
    ///
    /// # Errors
    /// The memory stays in use for longer than [`PATIENCE`].
    pub(super) async fn take(&self, bytes: usize, is_of_worker: bool) -> Result<Room, HttpError> {
        let (memory, together) = match (bytes <= ORDINARY, is_of_worker) {
            (true, true) => (&self.of_workers, OF_WORKERS_TOGETHER),
            (true, false) => (&self.ordinary, ORDINARY_TOGETHER),
            (false, _) => (&self.large, LARGE_TOGETHER),
        };
        let full = || {
            let message = format!(
                "a body of {bytes} bytes does not fit beside those that are on their way: {} of {together} bytes are free; try again",
                memory.available_permits()
            );
            HttpError::new(ErrorKind::Busy, message)
        };
        let count = u32::try_from(bytes).map_err(|_| full())?;
        let permit = tokio::time::timeout(PATIENCE, memory.clone().acquire_many_owned(count)).await;
        // The semaphore is never closed.
        let permit = permit.ok().and_then(Result::ok).ok_or_else(full)?;
        Ok(Room { bytes, permit })
    }
}

/// Reserved memory for a body.
#[derive(Debug)]
pub(super) struct Room {
    bytes: usize,
    permit: OwnedSemaphorePermit,
}

impl Room {
    pub(super) fn bytes(&self) -> usize {
        self.bytes
    }

    /// Returns the body with its reservation, which ends when the last reader drops the body.
    pub(super) fn holding(self, content: Vec<u8>) -> Bytes {
        Bytes::from_owner(Held {
            content,
            _permit: self.permit,
        })
    }
}

struct Held {
    content: Vec<u8>,
    _permit: OwnedSemaphorePermit,
}

impl AsRef<[u8]> for Held {
    fn as_ref(&self) -> &[u8] {
        &self.content
    }
}

#[cfg(test)]
mod tests {
    use futures::FutureExt;

    use super::*;

    #[tokio::test]
    async fn ordinary_bodies_of_others_leave_room_for_those_of_workers() {
        let memory = BodyMemory::new();
        let take = |is_of_worker| memory.take(ORDINARY, is_of_worker).now_or_never();
        let others: Vec<_> = std::iter::from_fn(|| take(false)).collect();
        assert_eq!(others.len(), 8);
        assert!(take(true).is_some());
    }

    #[tokio::test]
    async fn large_bodies_leave_room_for_ordinary_ones_and_give_theirs_back() {
        let memory = BodyMemory::new();
        let take = |bytes| memory.take(bytes, false).now_or_never().map(Result::unwrap);
        let (first, second) = (take(64 << 20).unwrap(), take(64 << 20).unwrap());
        assert!(take(ORDINARY + 1).is_none(), "it waits");
        assert_eq!(take(ORDINARY).unwrap().bytes(), ORDINARY);
        let body = first.holding(vec![7; 3]);
        let part = body.slice(1..);
        drop((body, second));
        assert!(take(64 << 20).is_some());
        assert!(take(128 << 20).is_none(), "a part of the first is still read");
        drop(part);
        assert!(take(128 << 20).is_some());
    }
}
