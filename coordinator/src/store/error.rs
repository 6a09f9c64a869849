//! Errors of the store.

/// Why the store cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// SQLite refuses.
    #[error("store {path}: {source}")]
    Sqlite {
        /// The file.
        path: String,
        /// What SQLite says.
        source: sqlx::Error,
    },
    /// The file is of another version of the program.
    #[error("store {path}: {source}")]
    Migrate {
        /// The file.
        path: String,
        /// What the migration says.
        source: sqlx::migrate::MigrateError,
    },
    /// Another coordinator has the file open.
    #[error("store {0}: another coordinator is using this file")]
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
        /// Why not.
        reason: String,
    },
    /// There is nothing to read.
    #[error("store {0}: no such file")]
    Missing(String),
}

impl StoreError {
    /// The same of a row: `place` says which.
    pub(super) fn within(self, place: &str) -> StoreError {
        match self {
            StoreError::Corrupt(what) => StoreError::Corrupt(format!("{place}: {what}")),
            StoreError::Sqlite {
                source: source @ sqlx::Error::ColumnDecode { .. },
                ..
            } => StoreError::Corrupt(format!("{place}: {source}")),
            other => other,
        }
    }
}

impl From<sqlx::Error> for StoreError {
    fn from(source: sqlx::Error) -> Self {
        StoreError::Sqlite {
            path: "query".into(),
            source,
        }
    }
}
