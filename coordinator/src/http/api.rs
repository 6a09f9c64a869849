//! The routes of `/v1`, collected from all resources.

use utoipa_axum::router::OpenApiRouter;

use super::{
    calibrations, campaign, document, effects, events, examples, experiments, growth, import, job_check,
    library, predictions, studies, work,
};
use crate::service::Service;

/// Returns the routes of `/v1`.
pub(super) fn api() -> OpenApiRouter<Service> {
    let routes = OpenApiRouter::new()
        .merge(experiments::routes())
        .merge(examples::routes())
        .merge(effects::routes())
        .merge(library::routes())
        .merge(import::routes())
        .merge(calibrations::routes())
        .merge(job_check::routes())
        .merge(events::routes())
        .merge(campaign::routes())
        .merge(studies::routes())
        .merge(predictions::routes())
        .merge(work::routes())
        .merge(growth::routes());
    OpenApiRouter::with_openapi(document::base()).nest("/v1", routes)
}
