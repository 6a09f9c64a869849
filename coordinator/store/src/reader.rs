//! Read access to a store through a pool of connections.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use sqlx::sqlite::SqliteConnectOptions;

use super::error::{StoreError, primary_code};
use super::file::{examine, file_of, options, pool, recognise};
use super::members::{Filled, filled};
use super::place::is_server;
use super::server;
use super::sql::{Connection, Pool, query_scalar};

/// SQLite's result codes where it cannot create its index of the write-ahead log: read-only, failed, full, cannot open.
const DENIED: [u32; 4] = [8, 10, 13, 14];

/// Read access to a store, also to one that another process is writing.
#[derive(Debug, Clone)]
pub struct Reader {
    pub(super) pool: Pool,
    /// The columns that the rows of an earlier version lack. They are kept in memory, because a reader does not change the store.
    pub(super) earlier_members: Option<Arc<BTreeMap<i64, Filled>>>,
}

impl Reader {
    /// Makes a reader of a store whose tables are up to date.
    pub(super) fn new(pool: Pool) -> Reader {
        Reader {
            pool,
            earlier_members: None,
        }
    }

    /// Opens an existing store for reading alone, also a file in a folder or on a disk that cannot be written.
    ///
    /// # Errors
    /// [`StoreError`] with the store and the reason.
    pub async fn open(path: &str) -> Result<Reader, StoreError> {
        if is_server(path) {
            let pool = server::pool(path).await?;
            let wrap = |source| StoreError::new(path, source);
            let mut connection = Connection::Postgres(pool.acquire().await.map_err(wrap)?.detach());
            server::recognise(&mut connection, path).await?;
            return Reader::new(Pool::Postgres(pool)).with_earlier_members().await;
        }
        let file = file_of(path);
        if !Path::new(file).is_file() {
            return Err(StoreError::Missing(file.into()));
        }
        examine(path)?;
        let options = options(path).read_only(true);
        let denied = match Reader::with(options.clone(), path).await {
            Err(StoreError::Database { source, .. })
                if primary_code(&source).is_some_and(|code| DENIED.contains(&code)) =>
            {
                source
            }
            opened => return opened,
        };
        let log = format!("{file}-wal");
        if std::fs::metadata(&log).is_ok_and(|log| log.len() > 0) {
            return Err(StoreError::Unfit {
                path: file.into(),
                reason: format!(
                    "{denied}: {log} has what the file lacks, and reading both needs a folder that can be written; copy both to one"
                ),
            });
        }
        // The file is complete: a writer would have left an index of the write-ahead log.
        Reader::with(options.immutable(true), path).await
    }

    /// Returns whether the store has been closed.
    pub fn is_closed(&self) -> bool {
        self.pool.is_closed()
    }

    /// Returns whether the store has no tables yet.
    ///
    /// # Errors
    /// The store cannot be read.
    pub async fn is_blank(&self) -> Result<bool, StoreError> {
        Ok(!self.has_table("calibrations").await?)
    }

    /// Returns whether the store has a table. A store of an earlier version that is opened for reading alone may lack it.
    pub(super) async fn has_table(&self, name: &str) -> Result<bool, StoreError> {
        let tables = match self.pool {
            Pool::Sqlite(_) => "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = ?",
            Pool::Postgres(_) => {
                "SELECT count(*) FROM information_schema.tables WHERE table_schema = current_schema() AND table_name = ?"
            }
        };
        let tables: i64 = query_scalar(tables).bind(name).fetch_one(&self.pool).await?;
        Ok(tables > 0)
    }

    /// Returns whether a table has a column.
    pub(super) async fn has_column(&self, table: &str, column: &str) -> Result<bool, StoreError> {
        let columns = match self.pool {
            Pool::Sqlite(_) => "SELECT count(*) FROM pragma_table_info(?) WHERE name = ?",
            Pool::Postgres(_) => {
                "SELECT count(*) FROM information_schema.columns
                 WHERE table_schema = current_schema() AND table_name = ? AND column_name = ?"
            }
        };
        let columns = query_scalar(columns).bind(table).bind(column);
        let columns: i64 = columns.fetch_one(&self.pool).await?;
        Ok(columns > 0)
    }

    async fn with(options: SqliteConnectOptions, path: &str) -> Result<Reader, StoreError> {
        let wrap = |source| StoreError::new(path, source);
        let pool = pool(options).await.map_err(wrap)?;
        recognise(&mut *pool.acquire().await.map_err(wrap)?, path).await?;
        Reader::new(Pool::Sqlite(pool)).with_earlier_members().await
    }

    async fn with_earlier_members(mut self) -> Result<Reader, StoreError> {
        if !self.has_table("calibrations").await? {
            return Ok(self);
        }
        // If a program stopped between adding the new columns and filling them, they are empty.
        let is_filled = self.has_column("calibrations", "role").await? && {
            let empty = query_scalar("SELECT count(*) FROM calibrations WHERE role IS NULL");
            let empty: i64 = empty.fetch_one(&self.pool).await?;
            empty == 0
        };
        if !is_filled {
            self.earlier_members = Some(Arc::new(filled(&self.pool).await?));
        }
        Ok(self)
    }
}
