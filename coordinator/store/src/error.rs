//! Errors of the store.

use sqlx::error::DatabaseError as _;
use sqlx::migrate::MigrateError;
use sqlx::sqlite::SqliteError;

use super::health::PATIENCE;
use super::place::{is_server, name_of};

/// The reason why the store cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refuses a statement or a connection.
    #[error("store {path}: {source}")]
    Database {
        /// The file, or the server without its password.
        path: String,
        /// The database's error.
        source: sqlx::Error,
    },
    /// The file is of another version of the program.
    #[error("store {path}: {source}")]
    Migrate {
        /// The file.
        path: String,
        /// The error of the migration.
        source: MigrateError,
    },
    /// The file was written by a later version of the program.
    #[error(
        "store {path}: a newer version of Grouser wrote it: its tables have version {found}, this program knows versions up to {supported}; use the newer program"
    )]
    Newer {
        /// The file.
        path: String,
        /// Version of its tables.
        found: i64,
        /// The latest version that this program knows.
        supported: i64,
    },
    /// The file is damaged.
    #[error(
        "store {path} is damaged: table {table}: {what}; put a backup back, or look at what can still be read with \"serve --read-only\" or --out"
    )]
    Damaged {
        /// The file.
        path: String,
        /// The first damaged table.
        table: String,
        /// Message of SQLite.
        what: String,
    },
    /// Another program holds a lock of SQLite.
    #[error("store {path}: another program holds a lock on this file, and has kept it for {} s", PATIENCE.as_secs())]
    Locked {
        /// The file.
        path: String,
    },
    /// Another coordinator has the store open.
    #[error("store {0}: another coordinator is using {what}", what = if is_server(.0) { "it" } else { "this file" })]
    InUse(String),
    /// A row cannot be read back.
    #[error("store: {0}")]
    Corrupt(String),
    /// The writer has ended.
    #[error("the store no longer accepts writes; the coordinator is shutting down")]
    Stopped,
    /// The file cannot be a store.
    #[error("store {path}: {reason}")]
    Unfit {
        /// The file.
        path: String,
        /// The reason.
        reason: String,
    },
    /// The store does not exist.
    #[error("store {0}: no such file")]
    Missing(String),
}

/// Returns whether SQLite refuses because another program holds a lock.
pub(super) fn is_locked(error: &sqlx::Error) -> bool {
    primary_code(error) == Some(5)
}

/// Returns the primary result code of SQLite.
pub(super) fn primary_code(error: &sqlx::Error) -> Option<u32> {
    let error = error.as_database_error()?.try_downcast_ref::<SqliteError>()?;
    let code = error.code()?;
    code.parse::<u32>().ok().map(|code| code & 0xff)
}

impl StoreError {
    /// Makes a store error from an error of SQLite about a file.
    pub(super) fn new(path: &str, source: sqlx::Error) -> StoreError {
        let path = name_of(path);
        match is_locked(&source) {
            true => StoreError::Locked { path },
            false => StoreError::Database { path, source },
        }
    }

    /// Makes a store error from an error of a migration.
    pub(super) fn from_migration(path: &str, source: MigrateError) -> StoreError {
        match source {
            MigrateError::Execute(source) | MigrateError::ExecuteMigration(source, _)
                if is_locked(&source) =>
            {
                StoreError::new(path, source)
            }
            source => StoreError::Migrate {
                path: name_of(path),
                source,
            },
        }
    }

    /// Makes an error about a row from an error about a value; `place` names the row.
    pub(super) fn within(self, place: &str) -> StoreError {
        match self {
            StoreError::Corrupt(what) => StoreError::Corrupt(format!("{place}: {what}")),
            StoreError::Database {
                source: source @ sqlx::Error::ColumnDecode { .. },
                ..
            } => StoreError::Corrupt(format!("{place}: {source}")),
            other => other,
        }
    }
}

impl From<sqlx::Error> for StoreError {
    fn from(source: sqlx::Error) -> Self {
        StoreError::Database {
            path: "query".into(),
            source,
        }
    }
}
