//! The OpenAPI document: what the handlers state, and what the gate answers besides.

use utoipa::OpenApi;
use utoipa::openapi::path::{Parameter, ParameterIn};
use utoipa::openapi::security::{Http, HttpAuthScheme, SecurityScheme};
use utoipa::openapi::{Content, Ref, RefOr, ResponseBuilder};

/// The document that the handlers complete.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "Grouser coordinator",
        description = "Calibrates wheel-soil contact models by Bayesian updating on a farm of workers. Every POST is \
                       application/json. Where the service asks for tokens, GET needs the role read or submit, POST \
                       and DELETE the role submit, /v1/work the role work, and /health none."
    ),
    security((), ("token" = []))
)]
struct Document;

/// Answers of the gate to a GET or DELETE, then those to a POST besides.
const REFUSALS: [(&str, &str); 5] = [
    ("401", "no token, or one that is not accepted"),
    ("403", "a foreign host or page, or a token of another role"),
    ("408", "the body has not arrived in time"),
    ("413", "the body is above the limit of the route"),
    ("415", "the body is not application/json"),
];

/// The document before the handlers: its information, and the scheme of the tokens.
pub(super) fn base() -> utoipa::openapi::OpenApi {
    let mut document = Document::openapi();
    let scheme = SecurityScheme::Http(Http::new(HttpAuthScheme::Bearer));
    let components = document.components.get_or_insert_default();
    components.add_security_scheme("token", scheme);
    document
}

/// Answer of a handler to a body or a query that it cannot read.
const UNREADABLE: (&str, &str) = ("400", "a body or query that is not of the form described");

/// The document of all handlers, with the answers of the gate, and to what cannot be read, where a handler states none of that
/// status.
pub(super) fn complete(mut document: utoipa::openapi::OpenApi) -> utoipa::openapi::OpenApi {
    for item in document.paths.paths.values_mut() {
        for (operation, refusals) in [
            (&mut item.get, &REFUSALS[..2]),
            (&mut item.delete, &REFUSALS[..2]),
            (&mut item.post, &REFUSALS[..]),
        ] {
            let Some(operation) = operation else { continue };
            let is_query = |own: &RefOr<Parameter>| matches!(own, RefOr::T(own) if own.parameter_in == ParameterIn::Query);
            let has_query = operation.parameters.iter().flatten().any(is_query);
            let is_read = operation.request_body.is_some() || has_query;
            for &(status, description) in refusals.iter().chain(is_read.then_some(&UNREADABLE)) {
                let body = Content::new(Some(Ref::from_schema_name("ErrorBody")));
                let refusal = ResponseBuilder::new()
                    .description(description)
                    .content("application/json", body);
                let stated = operation.responses.responses.entry(status.to_owned());
                stated.or_insert_with(|| refusal.build().into());
            }
        }
    }
    document
}
