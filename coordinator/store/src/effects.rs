//! Effects that users have added to the catalogue, by name and version.

use serde::Serialize;
use utoipa::ToSchema;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, Row, query};

/// An effect to store.
#[derive(Debug, Clone)]
pub struct NewEffect {
    /// Name of the effect.
    pub name: String,
    /// Text of the effect file.
    pub text: String,
    /// SHA-256 of the file, in hexadecimal digits.
    pub digest: String,
    /// The name of the token with which the effect was sent.
    pub created_by: Option<String>,
    /// Time of the insertion, in milliseconds since 1970.
    pub now_ms: i64,
}

/// A version of an effect that a user has added.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct EffectVersion {
    /// Number of the version, from 1.
    pub version: i64,
    /// SHA-256 of the effect file, in hexadecimal digits.
    pub digest: String,
    /// Time at which the version was added, in milliseconds since 1970.
    pub created_at_ms: i64,
    /// The name of the token with which the effect was sent; null if no token was required.
    pub created_by: Option<String>,
}

/// A version of an effect with its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredEffect {
    /// Name of the effect.
    pub name: String,
    /// Text of the effect file.
    pub text: String,
    /// Number, digest and origin of the version.
    pub version: EffectVersion,
}

/// The version of an effect after an attempt to store its text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AddedEffect {
    /// Name of the effect.
    pub name: String,
    /// The version that has the effect's text.
    pub version: EffectVersion,
    /// Whether the text is new.
    pub is_new: bool,
}

/// Inserts the next version of an effect, unless a version has the same text.
pub(super) async fn insert_effect(
    connection: &mut Connection,
    new: NewEffect,
) -> Result<AddedEffect, sqlx::Error> {
    let inserted = query(
        "INSERT INTO effects (name, version, text, digest, created_at_ms, created_by)
         VALUES (?1, 1 + (SELECT coalesce(max(version), 0) FROM effects WHERE name = ?1), ?2, ?3, ?4, ?5)
         ON CONFLICT (name, digest) DO NOTHING",
    )
    .bind(&new.name)
    .bind(new.text)
    .bind(&new.digest)
    .bind(new.now_ms)
    .bind(new.created_by)
    .execute(&mut *connection)
    .await?;
    let row = query("SELECT * FROM effects WHERE name = ? AND digest = ?")
        .bind(&new.name)
        .bind(&new.digest)
        .fetch_one(connection)
        .await?;
    Ok(AddedEffect {
        version: version(&row),
        name: new.name,
        is_new: inserted == 1,
    })
}

impl Reader {
    /// Reads the last version of every effect that users have added, by name. A store of before migration 17 has none.
    pub async fn user_effects(&self) -> Result<Vec<StoredEffect>, StoreError> {
        if !self.has_table("effects").await? {
            return Ok(Vec::new());
        }
        let last = "SELECT * FROM effects AS own
                    WHERE version = (SELECT max(version) FROM effects WHERE name = own.name) ORDER BY name";
        let rows = query(last).fetch_all(&self.pool).await?;
        Ok(rows.iter().map(stored).collect())
    }

    /// Reads every version of an effect that users have added, oldest first.
    pub async fn effect_versions(&self, name: &str) -> Result<Vec<StoredEffect>, StoreError> {
        if !self.has_table("effects").await? {
            return Ok(Vec::new());
        }
        let all = query("SELECT * FROM effects WHERE name = ? ORDER BY version");
        let rows = all.bind(name).fetch_all(&self.pool).await?;
        Ok(rows.iter().map(stored).collect())
    }
}

fn stored(row: &Row) -> StoredEffect {
    StoredEffect {
        name: row.get("name"),
        text: row.get("text"),
        version: version(row),
    }
}

fn version(row: &Row) -> EffectVersion {
    EffectVersion {
        version: row.get("version"),
        digest: row.get("digest"),
        created_at_ms: row.get("created_at_ms"),
        created_by: row.get("created_by"),
    }
}
