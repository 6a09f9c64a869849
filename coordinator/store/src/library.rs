//! The library: effects that users have added and that later searches try.

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, Row, query};

/// An effect of the library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LibraryRow {
    /// Name of the effect; its file is the last version under this name.
    pub name: String,
    /// Time at which it was added, in milliseconds since 1970.
    pub added_at_ms: i64,
    /// The name of the token with which it was added; `None` if no token was required.
    pub added_by: Option<String>,
    /// The study whose search found the law; `None` for an effect that a user wrote.
    pub found_in: Option<i64>,
}

/// A change of the library.
#[derive(Debug, Clone)]
pub enum LibraryChange {
    /// An effect is added, or takes the place of the one with its name.
    Add(LibraryRow),
    /// The effect of this name is removed; its versions stay.
    Remove(String),
}

/// Writes a change.
pub(super) async fn write(connection: &mut Connection, change: LibraryChange) -> Result<(), sqlx::Error> {
    let written = match change {
        LibraryChange::Add(row) => {
            query(
                "INSERT INTO library (name, added_at_ms, added_by, found_in) VALUES (?1, ?2, ?3, ?4)
                 ON CONFLICT (name) DO UPDATE SET added_at_ms = ?2, added_by = ?3, found_in = ?4",
            )
            .bind(row.name)
            .bind(row.added_at_ms)
            .bind(row.added_by)
            .bind(row.found_in)
            .execute(connection)
            .await
        }
        LibraryChange::Remove(name) => {
            query("DELETE FROM library WHERE name = ?")
                .bind(name)
                .execute(connection)
                .await
        }
    };
    written.map(drop)
}

impl Reader {
    /// Reads the library, by name. A store of before migration 26 has none.
    pub async fn library(&self) -> Result<Vec<LibraryRow>, StoreError> {
        if !self.has_table("library").await? {
            return Ok(Vec::new());
        }
        let rows = query("SELECT * FROM library ORDER BY name")
            .fetch_all(&self.pool)
            .await?;
        Ok(rows.iter().map(row).collect())
    }
}

fn row(row: &Row) -> LibraryRow {
    LibraryRow {
        name: row.get("name"),
        added_at_ms: row.get("added_at_ms"),
        added_by: row.get("added_by"),
        found_in: row.get("found_in"),
    }
}
