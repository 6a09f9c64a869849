//! `coordinator token`: who may use a service.

use std::fmt::Write;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};

use super::output::{note, say};
use crate::config::{StoreArguments, TokenCommand};
use crate::store::TokenTable;
use crate::token::{Role, Token, TokenHash, new_token};

/// Longest name of a token.
const LONGEST_NAME: usize = 64;

pub(super) async fn token(command: &TokenCommand) -> anyhow::Result<()> {
    match command {
        TokenCommand::Add { name, role, store } => add(name, *role, store).await,
        TokenCommand::List(store) => list(store).await,
        TokenCommand::Revoke { name, store } => revoke(name, store).await,
    }
}

fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}

async fn add(name: &str, role: Role, store: &StoreArguments) -> anyhow::Result<()> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-@".contains(c);
    if name.is_empty() || name.len() > LONGEST_NAME || !name.chars().all(is_plain) {
        bail!("name {name:?} must have 1 to {LONGEST_NAME} letters, digits, or any of . _ - @");
    }
    let secret = new_token().context("no random bits")?;
    let token = Token {
        name: name.to_owned(),
        role,
        hash: TokenHash::of(&secret),
        created_at_ms: now_ms(),
        is_revoked: false,
    };
    let mut table = TokenTable::open(&store.store).await?;
    let is_added = table.add(&token).await?;
    table.close().await?;
    if !is_added {
        bail!("{} has a token {name} already: revoke it first", store.store);
    }
    note(&format!(
        "token {name} with the role {}; it is not shown again:",
        role.name()
    ));
    Ok(say(&format!("{secret}\n"))?)
}

async fn list(store: &StoreArguments) -> anyhow::Result<()> {
    let mut table = TokenTable::open(&store.store).await?;
    let tokens = table.all().await?;
    table.close().await?;
    let mut text = format!("{:<24} {:<8} {}\n", "name", "role", "state");
    for token in tokens {
        let state = if token.is_revoked { "revoked" } else { "accepted" };
        let _ = writeln!(text, "{:<24} {:<8} {state}", token.name, token.role.name());
    }
    Ok(say(&text)?)
}

async fn revoke(name: &str, store: &StoreArguments) -> anyhow::Result<()> {
    let mut table = TokenTable::open(&store.store).await?;
    let is_revoked = table.revoke(name, now_ms()).await?;
    table.close().await?;
    if !is_revoked {
        bail!("{} has no token {name}", store.store);
    }
    Ok(say(&format!("token {name} is revoked\n"))?)
}
