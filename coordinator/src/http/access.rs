//! Checks the bearer token of a request against the role that its route needs.

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

/// Interval between two reads of the tokens: a change takes effect after this time.
const LOOK: Duration = Duration::from_secs(1);
/// Answer where a token is needed and none is sent.
const NEEDED: &str =
    "a token is needed: GROUSER_TOKEN or --token-file, sent as \"Authorization: Bearer TOKEN\"";
/// Answer to a token that lets nobody in.
const UNKNOWN: &str = "the token is unknown or revoked";

/// When a token is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenRule {
    /// Always.
    Always,
    /// Once the store has had a token; for a service that only this machine reaches.
    OnceThereIsOne,
    /// Never.
    Never,
}

impl TokenRule {
    /// Whether a store with these tokens asks for one.
    fn asks(self, tokens: &[Token]) -> bool {
        match self {
            TokenRule::Always => true,
            TokenRule::OnceThereIsOne => !tokens.is_empty(),
            TokenRule::Never => false,
        }
    }
}

/// The token of a hash, unless it is revoked.
fn valid<'a>(tokens: &'a [Token], hash: &TokenHash) -> Option<&'a Token> {
    let found = tokens.iter().find(|token| token.hash.is(hash));
    found.filter(|token| !token.is_revoked)
}

/// The sender of a request, for log and store.
#[derive(Debug, Clone, FromRequestParts)]
#[from_request(via(axum::Extension))]
pub(super) struct Caller {
    /// The name of the token, where one is asked for.
    name: Option<String>,
    hash: Option<TokenHash>,
    access: Access,
}

impl Caller {
    /// This program itself, which is asked for no token.
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

    /// The name of the token, where one is asked for.
    pub(super) fn into_name(self) -> Option<String> {
        self.name
    }

    /// Ready as soon as the sender would no longer be let in: its token was revoked, or tokens are asked for since. For what lasts long.
    pub(super) async fn shut_out(mut self) -> HttpError {
        let Access { rule, tokens } = &mut self.access;
        let hash = self.hash.as_ref();
        let is_out = |tokens: &Vec<Token>| {
            let is_known = hash.is_some_and(|hash| valid(tokens, hash).is_some());
            rule.asks(tokens) && !is_known
        };
        if tokens.wait_for(is_out).await.is_err() {
            // Nobody looks after the tokens any more: the service is going down.
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

/// The tokens of the store, as of a moment ago.
#[derive(Debug, Clone)]
pub(super) struct Access {
    rule: TokenRule,
    tokens: watch::Receiver<Vec<Token>>,
}

impl Access {
    /// Begins with these tokens, and reads them again and again for as long as the access is used.
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

    /// The sender of a request, if it may be sent.
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
            // A token that is stated before one is asked for keeps its polls and streams when the first one is.
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

/// The role that a request needs; nobody is asked for one to see whether the service is alive, or for the files of the page.
fn needed(method: &Method, path: &str) -> Option<TokenRole> {
    match path {
        "/health" | "/" | page::DOCS_PATH => None,
        _ if path.starts_with(page::FOLDER) => None,
        _ if path.starts_with("/v1/work/") => Some(TokenRole::Work),
        _ if [Method::GET, Method::HEAD].contains(method) => Some(TokenRole::Read),
        _ => Some(TokenRole::Submit),
    }
}
