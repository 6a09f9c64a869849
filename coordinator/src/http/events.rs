//! `/v1/calibrations/ID/events`: server-sent events of a calibration.
//!
//! `event: status` carries the same JSON as `GET /v1/calibrations/ID` whenever it has changed, checked twice a second; `event: stage`
//! carries each finished stage. The stream ends with the calibration, or when the watcher's token is revoked.

use std::convert::Infallible;
use std::time::Duration;

use axum::extract::State;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures::stream;
use futures::{Stream, StreamExt};
use shared::api::{CalibrationStatus, ErrorBody};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{HttpError, Id};
use crate::service::Service;

const LOOK: Duration = Duration::from_millis(500);

struct Watch {
    service: Service,
    id: i64,
    seen: Option<CalibrationStatus>,
    stages: usize,
    over: bool,
}

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new().routes(routes!(events))
}

/// An event of the stream.
#[derive(utoipa::ToSchema)]
#[expect(dead_code, reason = "the form of the stream, for the document alone")]
struct CalibrationEvent {
    /// What has changed: `status` or `stage`.
    event: String,
    /// The content, JSON as text.
    data: String,
}

/// Streams what happens to a calibration.
///
/// Server-sent events: `status` has the content of `GET /v1/calibrations/{id}` whenever that has changed, `stage`
/// each finished stage. The stream ends with the calibration, or soon after the token is revoked.
#[utoipa::path(get, path = "/calibrations/{id}/events", operation_id = "watch_calibration", tag = "calibrations",
    params(("id" = i64, Path)), responses(
    (status = 200, content_type = "text/event-stream", body = CalibrationEvent, description = "events: status, stage"),
    (status = 404, body = ErrorBody)))]
async fn events(
    State(service): State<Service>,
    Id(id): Id,
    caller: Caller,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>>>, HttpError> {
    service.status(id).await?;
    let watch = Watch {
        service,
        id,
        seen: None,
        stages: 0,
        over: false,
    };
    let batches = stream::unfold(watch, |mut watch| async move {
        if watch.over {
            return None;
        }
        let events = watch.look().await;
        Some((stream::iter(events.into_iter().map(Ok)), watch))
    });
    let events = batches.flatten().take_until(Box::pin(caller.shut_out()));
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}

impl Watch {
    /// Waits for a moment, then returns the new events.
    async fn look(&mut self) -> Vec<Event> {
        if self.seen.is_some() {
            tokio::time::sleep(LOOK).await;
        }
        let Ok(status) = self.service.status(self.id).await else {
            self.over = true;
            return Vec::new();
        };
        let mut events = Vec::new();
        // After a failed read, the next call returns the stages.
        if let Ok(stages) = self.service.store().reader().stages(self.id).await {
            for stage in stages.iter().skip(self.stages) {
                events.extend(Event::default().event("stage").json_data(stage));
            }
            self.stages = stages.len();
        }
        self.over = status.state.is_final();
        if self.seen.as_ref() != Some(&status) {
            events.extend(Event::default().event("status").json_data(&status));
            self.seen = Some(status);
        }
        events
    }
}
