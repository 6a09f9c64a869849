//! Requests to the routes of this program without a network. They do not pass the gate, so hosts, tokens and sizes of bodies are not
//! checked.

use axum::body::{Body, to_bytes};
use axum::extract::DefaultBodyLimit;
use axum::http::header::CONTENT_TYPE;
use axum::http::{Method, Request};
use axum::{Extension, Router};
use tower::ServiceExt as _;

use super::access::Caller;
use super::api::api;
use super::error::HttpError;
use crate::service::Service;
use shared::api::ErrorKind;

/// The routes of `/v1` of a service in this process.
#[derive(Debug, Clone)]
pub struct InProcess(Router);

impl InProcess {
    /// Makes the routes of a service.
    pub fn new(service: Service) -> InProcess {
        let (router, _) = api().split_for_parts();
        InProcess(
            router
                .layer(Extension(Caller::this_program()))
                .layer(DefaultBodyLimit::disable())
                .with_state(service),
        )
    }

    /// Sends a request with an optional JSON body. Returns the body of the answer.
    ///
    /// # Errors
    /// The refusal of the route. It includes the cause of an internal error, which a client over a network does not get.
    pub async fn answer(&self, method: &str, path: &str, body: Option<String>) -> Result<String, HttpError> {
        let invalid =
            |error: &dyn std::fmt::Display| HttpError::new(ErrorKind::InvalidBody, error.to_string());
        let method = Method::from_bytes(method.as_bytes()).map_err(|error| invalid(&error))?;
        let request = Request::builder()
            .method(method)
            .uri(path)
            .header(CONTENT_TYPE, "application/json")
            .body(body.map_or_else(Body::empty, Body::from))
            .map_err(|error| invalid(&error))?;
        let Ok(response) = self.0.clone().oneshot(request).await;
        let (parts, body) = response.into_parts();
        if let Some(error) = parts.extensions.get::<HttpError>() {
            return Err(error.clone());
        }
        let body = to_bytes(body, usize::MAX)
            .await
            .map_err(|error| invalid(&error))?;
        let text = String::from_utf8_lossy(&body).into_owned();
        match parts.status {
            status if status.is_success() => Ok(text),
            status => Err(invalid(&format!("{path} answered {status}: {text}"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::FarmSettings;
    use farm::calibration::VerificationRule;

    #[tokio::test]
    async fn a_request_in_this_process_gets_the_answer_or_the_refusal_of_its_route() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("grouser.db").display().to_string();
        let settings = FarmSettings {
            lease_ms: 1000,
            rule: VerificationRule::default(),
        };
        let service = Service::open(&store, settings).await.unwrap();
        let routes = InProcess::new(service.clone());
        assert_eq!(
            routes.answer("GET", "/v1/calibrations", None).await.unwrap(),
            "[]"
        );
        let refused = async |method, path, body: Option<&str>| {
            let answer = routes.answer(method, path, body.map(str::to_owned)).await;
            answer.unwrap_err().to_string()
        };
        assert_eq!(
            refused("GET", "/v1/calibrations/9", None).await,
            "there is no calibration 9"
        );
        // Bodies have no limit here. These runs exceed axum's default limit of 2 MiB.
        let runs = "1,2,3\n".repeat(1 << 20);
        for runs in ["", &runs] {
            let new = serde_json::json!({"runs": runs, "calibration": 1}).to_string();
            assert_eq!(
                refused("POST", "/v1/studies/9/runs", Some(&new)).await,
                "there is no study 9"
            );
        }
        assert!(
            refused("GET", "/v1/nothing", None)
                .await
                .contains("/v1/nothing answered 404")
        );
        service.close().await;
        let cause = refused("GET", "/v1/calibrations/9/stages", None).await;
        assert!(
            cause.contains("closed"),
            "the cause of an internal error: {cause}"
        );
    }
}
