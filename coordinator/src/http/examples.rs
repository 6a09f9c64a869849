//! `/v1/examples`: the built-in examples.

use std::collections::BTreeMap;

use axum::Json;
use shared::api::{ErrorBody, ErrorKind, NamedText};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{HttpError, Name};
use crate::example::{EXAMPLES, Example};
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(files))
}

/// An example in the list of examples.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct ListedExample {
    /// Name of the example.
    name: &'static str,
    /// Title of the example for people.
    title: &'static str,
    /// Sentence on what the example shows.
    summary: &'static str,
    /// Text of its job.
    job: &'static str,
}

/// The files of an example.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct ExampleFiles {
    /// Name of the example.
    name: &'static str,
    /// File of the job.
    job: NamedText,
    /// File of the experiment.
    experiment: NamedText,
    /// Texts of the files that the experiment names, by name.
    files: BTreeMap<&'static str, &'static str>,
}

/// Lists the examples.
///
/// Jobs that the program carries, to try it with.
#[utoipa::path(get, path = "/examples", operation_id = "list_examples", tag = "examples",
    responses((status = 200, description = "examples with their jobs", body = Vec<ListedExample>)))]
async fn list() -> Json<Vec<ListedExample>> {
    let listed = |example: Example| ListedExample {
        name: example.name,
        title: example.title,
        summary: example.summary,
        job: example.job.1,
    };
    Json(EXAMPLES.map(listed).into())
}

/// The files of an example.
///
/// Ready to be posted to `/v1/experiments` and `/v1/calibrations`.
#[utoipa::path(get, path = "/examples/{name}", operation_id = "get_example", tag = "examples",
    params(("name" = String, Path, description = "name of the example")), responses(
    (status = 200, description = "the files", body = ExampleFiles), (status = 404, body = ErrorBody)))]
async fn files(Name(name): Name) -> Result<Json<ExampleFiles>, HttpError> {
    let example = EXAMPLES.iter().find(|example| example.name == name);
    let example = example
        .ok_or_else(|| HttpError::new(ErrorKind::NotFound, format!("there is no example \"{name}\"")))?;
    let named = |(name, text): (&str, &str)| NamedText {
        name: name.to_owned(),
        text: text.to_owned(),
    };
    Ok(Json(ExampleFiles {
        name: example.name,
        job: named(example.job),
        experiment: named(example.experiment),
        files: example.files.iter().copied().collect(),
    }))
}
