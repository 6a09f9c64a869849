//! The OpenAPI document: the descriptions of the handlers, completed by what holds for all of them: answers of the gate, meanings of
//! statuses, numbers in paths, examples of bodies.

use utoipa::OpenApi;
use utoipa::openapi::path::{Operation, Parameter, ParameterIn};
use utoipa::openapi::security::{Http, HttpAuthScheme, SecurityScheme};
use utoipa::openapi::{Content, Ref, RefOr, ResponseBuilder};

use super::request_example::request_example;

/// The document before the handlers are added.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "Grouser coordinator",
        description = "Calibrates wheel-soil contact models by Bayesian updating on a farm of workers. Every POST is \
                       application/json. Where the service asks for tokens, GET needs the role read or submit, POST \
                       and DELETE the role submit, /v1/work the role work, and /health none."
    ),
    servers((url = "/", description = "the service that this document comes from")),
    tags(
        (name = "examples", description = "Jobs that the program carries, to try it with."),
        (name = "import", description = "Tables of other forms: workbooks, MATLAB files, text with decimal commas."),
        (name = "experiments", description = "Measured data sets: rig, wheels, soils, runs."),
        (name = "calibrations", description = "Jobs: submit, watch, pause, resume, cancel."),
        (name = "results", description = "What a calibration found. Of one that is not finished, most answer 409."),
        (name = "studies", description = "Calibrations on one experiment, with their error ledger, and how they grow."),
        (name = "effects", description = "The catalogue of effects that a model may miss."),
        (name = "work", description = "What workers talk to. Its messages have a version of their own, `protocol`."),
        (name = "service", description = "Health and figures of the service."),
    ),
    security((), ("token" = []))
)]
struct Document;

/// The answers of the gate: those to a GET or DELETE, then the further ones to a POST.
const REFUSALS: [(&str, &str); 6] = [
    ("401", "no token, or one that is not accepted"),
    ("403", "a foreign host or page, or a token of another role"),
    ("408", "the body has not arrived in time"),
    ("413", "the body is above the limit of the route"),
    ("415", "the body is not application/json"),
    (
        "429",
        "more bodies are on their way than there is memory for; try again",
    ),
];

/// Returns the document before the handlers are added: its information, and the scheme of the tokens.
pub(super) fn base() -> utoipa::openapi::OpenApi {
    let mut document = Document::openapi();
    let scheme = SecurityScheme::Http(Http::new(HttpAuthScheme::Bearer));
    let components = document.components.get_or_insert_default();
    components.add_security_scheme("token", scheme);
    document
}

/// The answer of a handler to a body or a query that it cannot read.
const UNREADABLE: (&str, &str) = ("400", "a body or query that is not of the form described");
/// The answer to a malformed request without body and query.
const BROKEN: (&str, &str) = ("400", "the request breaks the rules of HTTP, as with two hosts");

/// The meanings of error statuses for which the handler states none.
const MEANINGS: [(&str, &str); 4] = [
    ("404", "nothing has this number or name"),
    (
        "409",
        "the state does not allow it, as results of a calibration that is not finished",
    ),
    ("422", "a file in the body is malformed"),
    ("500", "something failed inside; the log of the service says what"),
];

/// The meaning of the number in a path, by the beginning of the path.
const NUMBERS: [(&str, &str); 3] = [
    ("/v1/calibrations/", "number of the calibration"),
    ("/v1/experiments/", "number of the experiment"),
    ("/v1/studies/", "number of the study"),
];

/// Completes the document of all handlers.
pub(super) fn complete(mut document: utoipa::openapi::OpenApi) -> utoipa::openapi::OpenApi {
    for (path, item) in &mut document.paths.paths {
        for (operation, refusals) in [
            (&mut item.get, &REFUSALS[..2]),
            (&mut item.delete, &REFUSALS[..2]),
            (&mut item.post, &REFUSALS[..]),
        ] {
            let Some(operation) = operation else { continue };
            name_number(path, operation);
            add_refusals(operation, refusals);
            add_meanings(operation);
            add_example(operation);
        }
    }
    document
}

/// Describes the number in the path.
fn name_number(path: &str, operation: &mut Operation) {
    let number = NUMBERS.iter().find(|(begin, _)| path.starts_with(begin));
    for parameter in operation.parameters.iter_mut().flatten() {
        if let (RefOr::T(parameter), Some((_, meaning))) = (parameter, number)
            && parameter.name == "id"
        {
            parameter.description.get_or_insert_with(|| (*meaning).to_owned());
        }
    }
}

/// Adds the answers of the gate, and those to unreadable requests, where the handler states none with this status.
fn add_refusals(operation: &mut Operation, refusals: &[(&str, &str)]) {
    let is_query = |parameter: &RefOr<Parameter>| matches!(parameter, RefOr::T(parameter) if parameter.parameter_in == ParameterIn::Query);
    let has_query = operation.parameters.iter().flatten().any(is_query);
    let is_read = operation.request_body.is_some() || has_query;
    let malformed = if is_read { &UNREADABLE } else { &BROKEN };
    for &(status, description) in refusals.iter().chain([malformed]) {
        let body = Content::new(Some(Ref::from_schema_name("ErrorBody")));
        let refusal = ResponseBuilder::new()
            .description(description)
            .content("application/json", body);
        let stated = operation.responses.responses.entry(status.to_owned());
        stated.or_insert_with(|| refusal.build().into());
    }
}

/// Describes the answers for which the handler has no description.
fn add_meanings(operation: &mut Operation) {
    for (status, meaning) in MEANINGS {
        if let Some(RefOr::T(response)) = operation.responses.responses.get_mut(status)
            && response.description.is_empty()
        {
            meaning.clone_into(&mut response.description);
        }
    }
}

/// Adds an example of the body, if the operation takes one.
fn add_example(operation: &mut Operation) {
    let Some(RefOr::T(body)) = &mut operation.request_body else {
        return;
    };
    let example = operation.operation_id.as_deref().and_then(request_example);
    if let Some(RefOr::T(content)) = body.content.get_mut("application/json") {
        content.example = example;
    }
}
