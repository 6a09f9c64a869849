//! Tokens in the store, which the command line changes while a coordinator may be running.

use sqlx::sqlite::{SqliteJournalMode, SqliteSynchronous};
use sqlx::{Connection, Row, SqliteConnection};

use super::error::StoreError;
use super::file::{examine, lock, options, recognise};
use super::migrations;
use super::reader::Reader;
use crate::token::{Role, Token, TokenHash};

const TOKENS: &str = "SELECT name, role, hash, created_at_ms, revoked_at_ms FROM tokens ORDER BY id";

impl Reader {
    /// Every token that was ever made, oldest first. A store of before migration 14 has none.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn tokens(&self) -> Result<Vec<Token>, StoreError> {
        if !self.has_table("tokens").await? {
            return Ok(Vec::new());
        }
        let rows = sqlx::query(TOKENS).fetch_all(&self.pool).await?;
        rows.iter().map(token).collect()
    }
}

fn token(row: &sqlx::sqlite::SqliteRow) -> Result<Token, StoreError> {
    let (role, hash): (String, Vec<u8>) = (row.get("role"), row.get("hash"));
    let corrupt = |what: &str| StoreError::Corrupt(format!("tokens: {what}"));
    Ok(Token {
        name: row.get("name"),
        role: Role::from_name(&role).ok_or_else(|| corrupt("unknown role"))?,
        hash: TokenHash(
            hash.try_into()
                .map_err(|_| corrupt("a hash is not of 32 bytes"))?,
        ),
        created_at_ms: row.get("created_at_ms"),
        is_revoked: row.get::<Option<i64>, _>("revoked_at_ms").is_some(),
    })
}

/// The tokens of a store, for changing them.
///
/// This is the one way to write to a store beside its coordinator: each change is one short transaction of SQLite, for
/// which the coordinator's writer waits.
#[derive(Debug)]
pub struct TokenTable {
    connection: SqliteConnection,
    path: String,
    /// Keeps a coordinator from starting meanwhile; none where one is running.
    _lock: Option<std::fs::File>,
}

impl TokenTable {
    /// Opens a store, also one in use; makes it or brings it up to date where no coordinator holds it.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn open(path: &str) -> Result<TokenTable, StoreError> {
        let wrap = |source| StoreError::of(path, source);
        examine(path)?;
        let (lock, is_free) = match lock(path) {
            Ok(lock) => (lock, true),
            Err(StoreError::InUse(_)) => (None, false),
            Err(error) => return Err(error),
        };
        let options = options(path)
            .create_if_missing(is_free)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Full);
        let mut connection = SqliteConnection::connect_with(&options).await.map_err(wrap)?;
        recognise(&mut connection, path).await?;
        if is_free {
            let migrated = migrations::migrator().run(&mut connection).await;
            migrated.map_err(|source| StoreError::of_migration(path, source))?;
        }
        Ok(TokenTable {
            connection,
            path: path.into(),
            _lock: lock,
        })
    }

    fn failed(&self, source: sqlx::Error) -> StoreError {
        StoreError::of(&self.path, source)
    }

    /// Every token that was ever made, oldest first.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn all(&mut self) -> Result<Vec<Token>, StoreError> {
        let rows = sqlx::query(TOKENS).fetch_all(&mut self.connection).await;
        rows.map_err(|e| self.failed(e))?.iter().map(token).collect()
    }

    /// Adds a token; whether its name was free.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn add(&mut self, token: &Token) -> Result<bool, StoreError> {
        let added = sqlx::query(
            "INSERT INTO tokens (name, role, hash, created_at_ms) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING",
        )
        .bind(&token.name)
        .bind(token.role.name())
        .bind(token.hash.0.to_vec())
        .bind(token.created_at_ms)
        .execute(&mut self.connection)
        .await;
        Ok(added.map_err(|e| self.failed(e))?.rows_affected() == 1)
    }

    /// Revokes the token of a name; whether there was one in use.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn revoke(&mut self, name: &str, now_ms: i64) -> Result<bool, StoreError> {
        let revoked =
            sqlx::query("UPDATE tokens SET revoked_at_ms = ? WHERE name = ? AND revoked_at_ms IS NULL")
                .bind(now_ms)
                .bind(name)
                .execute(&mut self.connection)
                .await;
        Ok(revoked.map_err(|e| self.failed(e))?.rows_affected() == 1)
    }

    /// Closes the store.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn close(self) -> Result<(), StoreError> {
        let TokenTable { connection, path, .. } = self;
        let closed = connection.close().await;
        closed.map_err(|source| StoreError::of(&path, source))
    }
}
