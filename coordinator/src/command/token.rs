//! `coordinator token`: adds, lists and revokes tokens.

use std::fmt::Write;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};
use shared::bearer::BearerToken;

use super::output::{note, say};
use crate::config::{StoreArguments, TokenCommand};
use record::{Token, TokenHash, TokenRole};
use store::{TokenTable, name_of};

/// The longest name of a token.
const LONGEST_NAME: usize = 64;
/// The smallest length of a token that was made by another program: 128 random bits in hexadecimal digits.
const MIN_SECRET: usize = 32;

pub(super) async fn token(command: &TokenCommand) -> anyhow::Result<()> {
    match command {
        TokenCommand::Add {
            name,
            role,
            from,
            store,
        } => add(name, *role, from.as_deref(), store).await,
        TokenCommand::List(store) => list(store).await,
        TokenCommand::Revoke { name, store } => revoke(name, store).await,
    }
}

fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}

async fn add(name: &str, role: TokenRole, from: Option<&Path>, store: &StoreArguments) -> anyhow::Result<()> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-@".contains(c);
    if name.is_empty() || name.len() > LONGEST_NAME || !name.chars().all(is_plain) {
        bail!("name {name:?} must have 1 to {LONGEST_NAME} letters, digits, or any of . _ - @");
    }
    let secret = match from {
        Some(file) => secret_of(file)?,
        None => new_token().context("no random bits")?,
    };
    let token = Token {
        name: name.to_owned(),
        role,
        hash: TokenHash::new(&secret),
        created_at_ms: now_ms(),
        is_revoked: false,
    };
    let mut table = TokenTable::open(&store.store).await?;
    if let Some(file) = from {
        let tokens = table.all().await?;
        let same = |stored: &&Token| stored.hash.is(&token.hash);
        match tokens.iter().rfind(same) {
            // A coordinator starts with a revoked secret, too, and refuses it.
            Some(stored) if stored.is_revoked => note(&format!(
                "the token of {} was revoked, and stays so",
                file.display()
            )),
            Some(stored) if (stored.name.as_str(), stored.role) != (name, role) => bail!(
                "{}: {} has this token already, as {} with the role {}",
                file.display(),
                name_of(&store.store),
                stored.name,
                stored.role.name()
            ),
            Some(_) => {}
            None => table.replace(&token).await?,
        }
        return Ok(table.close().await?);
    }
    let is_added = table.add(&token).await?;
    table.close().await?;
    if !is_added {
        bail!(
            "{} has a token {name} already: revoke it first",
            name_of(&store.store)
        );
    }
    note(&format!(
        "token {name} with the role {}; it is not shown again:",
        role.name()
    ));
    Ok(say(&format!("{secret}\n"))?)
}

/// Reads a token that was made by another program.
fn secret_of(file: &Path) -> anyhow::Result<String> {
    let token = BearerToken::find(Some(file), None)?;
    let secret = token.as_ref().map(BearerToken::expose).unwrap_or_default();
    if secret.len() < MIN_SECRET {
        bail!(
            "{}: a token of {} characters must have at least {MIN_SECRET}",
            file.display(),
            secret.len()
        );
    }
    Ok(secret.to_owned())
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
        bail!("{} has no token {name}", name_of(&store.store));
    }
    Ok(say(&format!("token {name} is revoked\n"))?)
}

/// Makes a new token: `grouser-` and 64 hexadecimal digits of random bits from the operating system.
///
/// # Errors
/// The operating system has no random bits.
fn new_token() -> Result<String, getrandom::Error> {
    let mut bits = [0; 32];
    getrandom::fill(&mut bits)?;
    let digits: String = bits.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(format!("grouser-{digits}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_token_has_256_bits_and_is_another_each_time() {
        let tokens = [new_token().unwrap(), new_token().unwrap()];
        assert!(tokens.iter().all(|token| token.len() == "grouser-".len() + 64));
        assert_ne!(tokens[0], tokens[1]);
    }
}
