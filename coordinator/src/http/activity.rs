//! The activity of a connection: whether it waits for its client, and since when.

use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes, HttpBody};
use axum::http::Response;
use hyper::body::{Frame, SizeHint};
use tokio::sync::Notify;

/// The state of one connection.
#[derive(Debug)]
pub(super) struct Activity {
    began: Instant,
    /// The time at which the client last sent or received data, after `began` `[ms]`.
    progress_ms: AtomicU64,
    /// The number of requests that have arrived completely and are not answered completely.
    answering: AtomicU32,
    /// Whether data of an answer wait for the client.
    is_stalled: AtomicBool,
    closed: Notify,
}

impl Activity {
    /// Makes the activity of a connection that begins now.
    pub(super) fn begin() -> Arc<Activity> {
        Arc::new(Activity {
            began: Instant::now(),
            progress_ms: AtomicU64::new(0),
            answering: AtomicU32::new(0),
            is_stalled: AtomicBool::new(false),
            closed: Notify::new(),
        })
    }

    fn age_ms(&self) -> u64 {
        u64::try_from(self.began.elapsed().as_millis()).unwrap_or(u64::MAX)
    }

    /// Records that the client has sent data.
    pub(super) fn received(&self) {
        self.progress_ms.store(self.age_ms(), Ordering::Relaxed);
    }

    /// Records that the client has received data.
    pub(super) fn sent(&self) {
        self.received();
        self.is_stalled.store(false, Ordering::Relaxed);
    }

    /// Records that the client does not receive data.
    pub(super) fn stalled(&self) {
        self.is_stalled.store(true, Ordering::Relaxed);
    }

    /// Returns whether the client does not receive the data that are written to it.
    pub(super) fn is_stalled(&self) -> bool {
        self.is_stalled.load(Ordering::Relaxed)
    }

    /// Returns how long the connection has waited for its client; `None` while the client waits for the service.
    pub(super) fn waiting(&self) -> Option<Duration> {
        let waits = self.is_stalled() || self.answering.load(Ordering::Relaxed) == 0;
        let progress_ms = self.progress_ms.load(Ordering::Relaxed);
        waits.then(|| Duration::from_millis(self.age_ms().saturating_sub(progress_ms)))
    }

    /// Requests the end of the connection.
    pub(super) fn close(&self) {
        self.closed.notify_one();
    }

    /// Waits until the end of the connection is requested.
    pub(super) async fn closed(&self) {
        self.closed.notified().await;
    }

    /// Marks that the client waits for the service, until the returned guard is dropped.
    pub(super) fn answer(self: &Arc<Self>) -> Answering {
        self.answering.fetch_add(1, Ordering::Relaxed);
        Answering(self.clone())
    }
}

/// A guard: while it exists, the client waits for the service.
#[derive(Debug)]
pub(super) struct Answering(Arc<Activity>);

impl Answering {
    /// Keeps the guard until the body of the answer has been handed to the connection.
    pub(super) fn through(self, response: Response<Body>) -> Response<Body> {
        response.map(|body| {
            Body::new(AnswerBody {
                body,
                _answering: self,
            })
        })
    }
}

impl Drop for Answering {
    fn drop(&mut self) {
        self.0.received();
        self.0.answering.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The body of an answer with the guard.
struct AnswerBody {
    body: Body,
    _answering: Answering,
}

impl HttpBody for AnswerBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_connection_waits_for_its_client_unless_an_answer_is_being_made() {
        let activity = Activity::begin();
        assert!(activity.waiting().is_some(), "a head has yet to arrive");
        let answering = activity.answer();
        assert_eq!(activity.waiting(), None);
        activity.stalled();
        assert!(
            activity.waiting().is_some(),
            "the client does not take its answer"
        );
        activity.sent();
        assert_eq!(activity.waiting(), None);
        let response = answering.through(Response::new(Body::from("answer")));
        assert_eq!(activity.waiting(), None, "the body has yet to be written");
        drop(response);
        assert!(activity.waiting().is_some());
    }
}
