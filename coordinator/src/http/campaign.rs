//! `/v1/calibrations/ID/follow`: a campaign while it lasts.
//!
//! A POST with all further rows so far answers what they change. A GET is a stream of server-sent events: `event: followed` carries the last
//! answer and each later one, whoever asked for it. The stream ends when the watcher's token is revoked.

use std::convert::Infallible;

use axum::Json;
use axum::extract::State;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures::{Stream, StreamExt, stream};
use prediction::follow::Followed;
use shared::api::{ErrorBody, NewFollow};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Id};
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new().routes(routes!(follow, campaign))
}

/// An event of the stream.
#[derive(utoipa::ToSchema)]
#[expect(dead_code, reason = "the form of the stream, for the document alone")]
struct CampaignEvent {
    /// What has come: `followed`.
    event: String,
    /// The answer of `POST /v1/calibrations/{id}/follow`, JSON as text.
    data: String,
}

/// What further runs change.
///
/// Posterior, weights of the models and verdict of a search with further runs, by the draws so far: weighted anew, or by a few stages of new
/// ones. The answer has the runs to make next, the probability that the first settles what is missing, and which run contradicts all others.
/// Who watches the campaign has the answer, too. Nothing is stored; `POST /v1/studies/ID/runs` adds runs for good.
#[utoipa::path(post, path = "/calibrations/{id}/follow", operation_id = "follow", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), request_body = NewFollow, responses(
    (status = 200, description = "the campaign with all runs", body = Followed),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, has no draws, or its model cannot be evaluated here"),
    (status = 422, body = ErrorBody, description = "a row is malformed, or its run exists already"),
))]
async fn follow(
    State(service): State<Service>,
    Id(id): Id,
    Body(asked): Body<NewFollow>,
) -> Result<Json<Followed>, HttpError> {
    Ok(Json(service.follow(id, asked).await?))
}

/// Streams what further runs change.
///
/// Server-sent events: `followed` has the answer to the further runs of this calibration, the last one at once and then each new one. The
/// service forgets them when it ends. The stream ends soon after the token is revoked.
#[utoipa::path(get, path = "/calibrations/{id}/follow", operation_id = "watch_campaign", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), responses(
    (status = 200, content_type = "text/event-stream", body = CampaignEvent, description = "events: followed"),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished")))]
async fn campaign(
    State(service): State<Service>,
    Id(id): Id,
    caller: Caller,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>>>, HttpError> {
    let mut answers = service.campaign(id).await?;
    // The last answer, which came before this watcher, is the first event.
    answers.mark_changed();
    let events = stream::unfold(answers, |mut answers| async move {
        answers.changed().await.ok()?;
        let answer = answers.borrow_and_update().clone();
        Some((answer, answers))
    });
    let events = events.filter_map(|answer| async move {
        let event = Event::default().event("followed").json_data(&*answer?);
        event.ok().map(Ok)
    });
    let events = events.take_until(Box::pin(caller.shut_out()));
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}
