//! Authorisation: the check of a request's bearer token against the role that its route needs.

use std::fmt;
use std::time::Duration;

use axum::extract::FromRequestParts;
use axum::http::header::AUTHORIZATION;
use axum::http::{HeaderMap, Method};
use shared::api::ErrorKind;
use tokio::sync::watch;

use super::error::HttpError;
use super::page;
use record::{Token, TokenHash, TokenRole};
use store::Reader;

/// The interval between two reads of the tokens, and so the delay with which a changed token takes effect.
const LOOK: Duration = Duration::from_secs(1);
/// The answer where a token is required and none is sent.
const NEEDED: &str =
    "a token is needed: GROUSER_TOKEN or --token-file, sent as \"Authorization: Bearer TOKEN\"";
/// The answer to an unknown or revoked token.
const UNKNOWN: &str = "the token is unknown or revoked";

/// The rule that decides whether a token is required.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenRule {
    /// A token is always required.
    Always,
    /// A token is required once the store has had one. This is for a service that only this machine can reach.
    OnceThereIsOne,
    /// No token is required.
    Never,
}

impl TokenRule {
    /// Returns whether requests to a store with these tokens need one.
    fn asks(self, tokens: &[Token]) -> bool {
        match self {
            TokenRule::Always => true,
            TokenRule::OnceThereIsOne => !tokens.is_empty(),
            TokenRule::Never => false,
        }
    }
}

/// Returns the token with a hash, unless it is revoked.
fn valid<'a>(tokens: &'a [Token], hash: &TokenHash) -> Option<&'a Token> {
    let found = tokens.iter().find(|token| token.hash.is(hash));
    found.filter(|token| !token.is_revoked)
}

/// The sender of a request, for the log and the store.
#[derive(Debug, Clone, FromRequestParts)]
#[from_request(via(axum::Extension))]
pub(super) struct Caller {
    /// The name of the token, where one is required.
    name: Option<String>,
    hash: Option<TokenHash>,
    access: Access,
}

impl Caller {
    /// Returns this program as the sender, which needs no token.
    pub(super) fn this_program() -> Caller {
        let access = Access {
            rule: TokenRule::Never,
            tokens: watch::channel(Vec::new()).1,
        };
        Caller {
            name: None,
            hash: None,
            access,
        }
    }

    /// Returns the name by which the farm knows a worker of this sender: its own, after the token's, so that nobody acts for the worker of
    /// another token.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidBody`]: without a token, a name with a slash would look like that of a token's worker.
    pub(super) fn worker(&self, name: String) -> Result<String, HttpError> {
        match &self.name {
            Some(token) => Ok(format!("{token}/{name}")),
            None if name.contains('/') => {
                let message = format!("worker: {name:?} must have no slash");
                Err(HttpError::new(ErrorKind::InvalidBody, message))
            }
            None => Ok(name),
        }
    }

    /// Returns the name of the token, where one is required.
    pub(super) fn into_name(self) -> Option<String> {
        self.name
    }

    /// Returns an error as soon as the sender would no longer be admitted, because its token was revoked or tokens have become required.
    /// Long requests watch this future.
    pub(super) async fn shut_out(mut self) -> HttpError {
        let Access { rule, tokens } = &mut self.access;
        let hash = self.hash.as_ref();
        let is_out = |tokens: &Vec<Token>| {
            let is_known = hash.is_some_and(|hash| valid(tokens, hash).is_some());
            rule.asks(tokens) && !is_known
        };
        if tokens.wait_for(is_out).await.is_err() {
            // The task that reads the tokens has ended, because the service is ending.
            std::future::pending::<()>().await;
        }
        match hash {
            Some(_) => HttpError::new(ErrorKind::Unauthorized, UNKNOWN),
            None => HttpError::new(ErrorKind::Unauthorized, NEEDED),
        }
    }
}

impl fmt::Display for Caller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.name {
            Some(name) => write!(f, "{}", name.escape_debug()),
            None => f.write_str("no token"),
        }
    }
}

/// The tokens of the store, which a task reads again and again.
#[derive(Debug, Clone)]
pub(super) struct Access {
    rule: TokenRule,
    tokens: watch::Receiver<Vec<Token>>,
}

impl Access {
    /// Begins with these tokens, and reads them again and again while the access is in use.
    pub(super) fn start(rule: TokenRule, tokens: Vec<Token>, reader: Reader) -> Access {
        let (sender, tokens) = watch::channel(tokens);
        tokio::spawn(async move {
            while !sender.is_closed() {
                tokio::time::sleep(LOOK).await;
                match reader.tokens().await {
                    Ok(tokens) => drop(sender.send_replace(tokens)),
                    Err(_) if reader.is_closed() => return,
                    Err(error) => tracing::error!(%error, "failed to read the tokens; the last ones stand"),
                }
            }
        });
        Access { rule, tokens }
    }

    /// Returns the sender of a request, if the request is authorised.
    pub(super) fn caller(
        &self,
        method: &Method,
        path: &str,
        headers: &HeaderMap,
    ) -> Result<Caller, HttpError> {
        let tokens = self.tokens.borrow();
        let is_asked_for = self.rule.asks(&tokens);
        let caller = |name, hash| Caller {
            name,
            hash,
            access: self.clone(),
        };
        let stated = headers.get(AUTHORIZATION).and_then(|value| value.to_str().ok());
        let stated = stated.and_then(|text| text.split_once(' '));
        let stated = stated.filter(|(scheme, _)| scheme.eq_ignore_ascii_case("bearer"));
        let hash = stated.map(|(_, token)| TokenHash::new(token.trim()));
        let Some(needed) = needed(method, path).filter(|_| is_asked_for) else {
            // A token that was sent before tokens were required keeps its polls and streams when the first token is made.
            return Ok(caller(None, hash));
        };
        let refused = |message| HttpError::new(ErrorKind::Unauthorized, message);
        let hash = hash.ok_or_else(|| refused(NEEDED))?;
        let token = valid(&tokens, &hash).ok_or_else(|| refused(UNKNOWN))?;
        if token.role.includes(needed) {
            return Ok(caller(Some(token.name.clone()), Some(hash)));
        }
        let message = format!(
            "the token {:?} has the role {}; {method} {path} needs the role {}",
            token.name,
            token.role.name(),
            needed.name()
        );
        Err(HttpError::new(ErrorKind::Forbidden, message))
    }
}

/// Returns the role that a request needs; `None` for `/health` and the files of the page.
fn needed(method: &Method, path: &str) -> Option<TokenRole> {
    match path {
        "/health" | "/" | page::DOCS_PATH => None,
        _ if path.starts_with(page::FOLDER) => None,
        _ if path.starts_with("/v1/work/") => Some(TokenRole::Work),
        _ if [Method::GET, Method::HEAD].contains(method) => Some(TokenRole::Read),
        _ => Some(TokenRole::Submit),
    }
}
