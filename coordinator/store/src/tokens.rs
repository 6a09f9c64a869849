//! Access tokens in the store. The command line changes them while a coordinator may be running.

use super::error::StoreError;
use super::opening;
use super::reader::Reader;
use super::sql::{Connection, Row, query};
use record::{Token, TokenHash, TokenRole};

const TOKENS: &str = "SELECT name, role, hash, created_at_ms, revoked_at_ms FROM tokens ORDER BY id";

impl Reader {
    /// Reads every token, revoked ones included, oldest first. A store of before migration 14 has none.
    pub async fn tokens(&self) -> Result<Vec<Token>, StoreError> {
        if !self.has_table("tokens").await? {
            return Ok(Vec::new());
        }
        let rows = query(TOKENS).fetch_all(&self.pool).await?;
        rows.iter().map(token).collect()
    }
}

fn token(row: &Row) -> Result<Token, StoreError> {
    let (role, hash): (String, Vec<u8>) = (row.get("role"), row.get("hash"));
    let corrupt = |what: &str| StoreError::Corrupt(format!("tokens: {what}"));
    Ok(Token {
        name: row.get("name"),
        role: TokenRole::from_name(&role).ok_or_else(|| corrupt("unknown role"))?,
        hash: TokenHash(
            hash.try_into()
                .map_err(|_| corrupt("a hash is not of 32 bytes"))?,
        ),
        created_at_ms: row.get("created_at_ms"),
        is_revoked: row.get::<Option<i64>>("revoked_at_ms").is_some(),
    })
}

/// Inserts a token unless its name is in use. Returns how many rows were inserted.
async fn insert_token(connection: &mut Connection, token: &Token) -> Result<u64, sqlx::Error> {
    query("INSERT INTO tokens (name, role, hash, created_at_ms) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING")
        .bind(&token.name)
        .bind(token.role.name())
        .bind(token.hash.0.to_vec())
        .bind(token.created_at_ms)
        .execute(connection)
        .await
}

/// Write access to the tokens of a store.
///
/// Only this type writes to a store beside its coordinator. Each change is one short transaction, for which the coordinator's writer waits.
#[derive(Debug)]
pub struct TokenTable {
    connection: Connection,
    path: String,
    /// The lock that keeps a coordinator from starting meanwhile; `None` where one is running.
    _lock: Option<std::fs::File>,
}

impl TokenTable {
    /// Opens a store, also one in use. If no coordinator holds it, it is created or brought up to date.
    pub async fn open(path: &str) -> Result<TokenTable, StoreError> {
        let (connection, lock) = opening::beside(path).await?;
        Ok(TokenTable {
            connection,
            path: path.into(),
            _lock: lock,
        })
    }

    fn failed(&self, source: sqlx::Error) -> StoreError {
        StoreError::new(&self.path, source)
    }

    /// Returns every token, revoked ones included, oldest first.
    pub async fn all(&mut self) -> Result<Vec<Token>, StoreError> {
        let rows = query(TOKENS).fetch_all(&mut self.connection).await;
        rows.map_err(|e| self.failed(e))?.iter().map(token).collect()
    }

    /// Adds a token. Returns whether its name was free.
    pub async fn add(&mut self, token: &Token) -> Result<bool, StoreError> {
        let added = insert_token(&mut self.connection, token).await;
        Ok(added.map_err(|e| self.failed(e))? == 1)
    }

    /// Adds a token and revokes the token of the same name, unless both are the same.
    pub async fn replace(&mut self, token: &Token) -> Result<(), StoreError> {
        let replaced = async {
            self.connection.begin().await?;
            query(
                "UPDATE tokens SET revoked_at_ms = ? WHERE name = ? AND revoked_at_ms IS NULL AND hash <> ?",
            )
            .bind(token.created_at_ms)
            .bind(&token.name)
            .bind(token.hash.0.to_vec())
            .execute(&mut self.connection)
            .await?;
            insert_token(&mut self.connection, token).await?;
            self.connection.commit().await
        };
        replaced.await.map_err(|source| self.failed(source))
    }

    /// Revokes the token with a name. Returns whether there was one in use.
    pub async fn revoke(&mut self, name: &str, now_ms: i64) -> Result<bool, StoreError> {
        let revoked = query("UPDATE tokens SET revoked_at_ms = ? WHERE name = ? AND revoked_at_ms IS NULL")
            .bind(now_ms)
            .bind(name)
            .execute(&mut self.connection)
            .await;
        Ok(revoked.map_err(|e| self.failed(e))? == 1)
    }

    /// Closes the store.
    pub async fn close(self) -> Result<(), StoreError> {
        let TokenTable { connection, path, .. } = self;
        let closed = connection.close().await;
        closed.map_err(|source| StoreError::new(&path, source))
    }
}
