//! `/v1/examples`: jobs with measurements to begin with, as they stand in the repository.

use std::collections::BTreeMap;

use axum::Json;
use axum::extract::Path;
use shared::api::{ErrorBody, ErrorKind, NamedText};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::HttpError;
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(one))
}

/// An example, as it is embedded.
struct Embedded {
    name: &'static str,
    title: &'static str,
    summary: &'static str,
    job: &'static str,
    experiment: &'static str,
    runs: &'static str,
}

const EXAMPLES: [Embedded; 3] = [
    Embedded {
        name: "hidden-effect",
        title: "A hidden effect",
        summary: "synthetic runs of a wheel whose soil has an effect more than the model: the search finds it, adds it and calibrates again; seconds",
        job: include_str!("../../../examples/hidden-effect/job.toml"),
        experiment: include_str!("../../../examples/hidden-effect/experiment.toml"),
        runs: include_str!("../../../examples/hidden-effect/runs.csv"),
    },
    Embedded {
        name: "cmu-sand",
        title: "A smooth and a grousered wheel on sand",
        summary: "single-wheel tests by Carnegie Mellon University (MIT licence): the model misses what interpolation shows; seconds",
        job: include_str!("../../../examples/cmu-sand/job.toml"),
        experiment: include_str!("../../../examples/cmu-sand/experiment.toml"),
        runs: include_str!("../../../examples/cmu-sand/runs.csv"),
    },
    Embedded {
        name: "cmu-sand-discover",
        title: "What is missing on that sand",
        summary: "the same tests with a search for a missing effect; half a minute",
        job: include_str!("../../../examples/cmu-sand/discover.toml"),
        experiment: include_str!("../../../examples/cmu-sand/discover-experiment.toml"),
        runs: include_str!("../../../examples/cmu-sand/runs.csv"),
    },
];

/// An example in the list.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct ExampleItem {
    /// Its name.
    name: String,
    /// Its title.
    title: String,
    /// What it shows, and how long it takes.
    summary: String,
}

/// The files of an example.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Example {
    /// Its name.
    name: String,
    /// The job.
    job: NamedText,
    /// The experiment.
    experiment: NamedText,
    /// The files that the experiment names.
    files: BTreeMap<String, String>,
}

/// Examples to begin with.
#[utoipa::path(get, path = "/examples", responses((status = 200, body = Vec<ExampleItem>)))]
async fn list() -> Json<Vec<ExampleItem>> {
    let item = |example: &Embedded| ExampleItem {
        name: example.name.to_owned(),
        title: example.title.to_owned(),
        summary: example.summary.to_owned(),
    };
    Json(EXAMPLES.iter().map(item).collect())
}

/// The files of an example, ready to be sent.
#[utoipa::path(get, path = "/examples/{name}", params(("name" = String, Path)), responses(
    (status = 200, body = Example), (status = 404, body = ErrorBody)))]
async fn one(Path(name): Path<String>) -> Result<Json<Example>, HttpError> {
    let example = EXAMPLES.iter().find(|example| example.name == name);
    let example = example
        .ok_or_else(|| HttpError::new(ErrorKind::NotFound, format!("there is no example {name:?}")))?;
    let file = |name: &str, text: &str| NamedText {
        name: name.to_owned(),
        text: text.to_owned(),
    };
    Ok(Json(Example {
        name: example.name.to_owned(),
        job: file("job.toml", example.job),
        experiment: file("experiment.toml", example.experiment),
        files: BTreeMap::from([("runs.csv".to_owned(), example.runs.to_owned())]),
    }))
}
