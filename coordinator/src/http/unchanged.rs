//! Answers that are asked for again and again: one that has not changed since is not sent again.

use std::hash::{DefaultHasher, Hash, Hasher};

use axum::Json;
use axum::http::header::{CACHE_CONTROL, ETAG, IF_NONE_MATCH};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

use super::error::HttpError;

/// Makes the answer to a request with these headers: 304 where the client has it already.
///
/// # Errors
/// The answer has no form in JSON.
pub(super) fn answer<T: Serialize>(headers: &HeaderMap, value: &T) -> Result<Response, HttpError> {
    let value = serde_json::to_value(value).map_err(|error| HttpError::internal(&error))?;
    let mut hasher = DefaultHasher::new();
    value.to_string().hash(&mut hasher);
    // A weak tag: the same answer may be sent compressed.
    let tag = format!("W/\"{:016x}\"", hasher.finish());
    let known = headers.get(IF_NONE_MATCH).and_then(|known| known.to_str().ok());
    let is_known = known.is_some_and(|known| known.split(',').any(|one| one.trim() == tag));
    let head = [(ETAG, tag), (CACHE_CONTROL, "no-cache".to_owned())];
    Ok(match is_known {
        true => (StatusCode::NOT_MODIFIED, head).into_response(),
        false => (head, Json(value)).into_response(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_that_the_client_has_is_not_sent_again() {
        let first = answer(&HeaderMap::new(), &[1, 2]).unwrap();
        assert_eq!(first.status(), StatusCode::OK);
        let mut headers = HeaderMap::new();
        headers.insert(IF_NONE_MATCH, first.headers()[ETAG].clone());
        assert_eq!(
            answer(&headers, &[1, 2]).unwrap().status(),
            StatusCode::NOT_MODIFIED
        );
        assert_eq!(answer(&headers, &[1, 3]).unwrap().status(), StatusCode::OK);
    }
}
