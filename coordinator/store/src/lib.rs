//! The store: everything that the coordinator keeps, in an SQLite file or in a PostgreSQL server. No other crate contains SQL.
//!
//! One task writes (`writer`); all others read through a pool of connections. Statements are written once, in the SQL that both databases
//! have (`sql`). Parts that only one database has are in `file` and `server`. `migrations/README.md` explains the tables.

mod backup;
mod blob;
mod change;
mod checksum;
mod copy;
mod damage;
mod details;
mod effects;
mod error;
mod expired_values;
mod facts;
mod file;
#[cfg(test)]
mod fixture;
mod health;
mod insert;
mod json;
mod library;
mod lists;
mod members;
mod migrations;
mod observables;
mod older_blob;
mod opening;
mod place;
mod prior;
mod read;
mod reader;
mod recovery;
mod removal;
mod repeats;
mod results;
mod server;
mod sql;
mod stamp;
mod theta;
mod tokens;
mod verification;
mod writer;

use std::path::PathBuf;

pub use backup::BackupError;
pub use change::StateChange;
pub use checksum::TableCheck;
pub use copy::copy_store;
pub use effects::{AddedEffect, EffectVersion, NewEffect, StoredEffect};
pub use error::StoreError;
pub use file::file_of;
use file::options;
pub use health::StoreHealth;
pub use insert::{NewCalibrationRow, NewStudy, StudyIds};
pub use library::{LibraryChange, LibraryRow};
pub use lists::{IdPage, ListedCalibration};
pub use place::{is_server, name_of};
pub use read::{StoredStudy, StoredWebhook};
pub use reader::Reader;
pub use results::StudyResults;
use sql::{Connection, Pool, query_scalar};
pub use stamp::{Doubts, Stamp, is_of_members, members_stamp};
pub use tokens::TokenTable;
pub use writer::Writer;

/// The store: a pool of readers and the way to the one writer.
#[derive(Debug, Clone)]
pub struct Store {
    reader: Reader,
    writer: Writer,
    /// The path of the file; `None` for a server.
    file: Option<PathBuf>,
    epoch: u64,
    is_read_only: bool,
}

impl Store {
    /// Opens or creates a store, brings its tables up to date, starts the writer and a new epoch.
    ///
    /// # Errors
    /// [`StoreError`] with the store and the database's reason; [`StoreError::InUse`] where another coordinator holds it.
    pub async fn open(path: &str, now_ms: i64) -> Result<Store, StoreError> {
        let wrap = |source| StoreError::new(path, source);
        let (mut connection, lock) = opening::to_write(path).await?;
        let epoch = begin_epoch(&mut connection, now_ms).await.map_err(wrap)?;
        let pool = match is_server(path) {
            true => Pool::Postgres(server::pool(path).await?),
            false => Pool::Sqlite(file::pool(options(path)).await.map_err(wrap)?),
        };
        let writer = Writer::start(connection, lock);
        Ok(Store {
            reader: Reader::new(pool),
            writer,
            file: (!is_server(path)).then(|| file_of(path).into()),
            epoch,
            is_read_only: false,
        })
    }

    /// Opens a store for reading alone, also beside a coordinator that writes to it. The writer of such a store refuses every write.
    pub async fn open_read_only(path: &str) -> Result<Store, StoreError> {
        Ok(Store {
            reader: Reader::open(path).await?,
            writer: Writer::none(),
            file: (!is_server(path)).then(|| file_of(path).into()),
            epoch: 0,
            is_read_only: true,
        })
    }

    /// Logs a warning if a short check finds damage in the file.
    ///
    /// # Errors
    /// [`StoreError`] where there is no connection. Damage is not an error.
    pub async fn warn_of_damage(&self) -> Result<(), StoreError> {
        if let (Pool::Sqlite(pool), Some(file)) = (&self.reader.pool, &self.file) {
            let mut connection = pool.acquire().await?;
            if let Err(error) = damage::check(&mut connection, &file.display().to_string()).await {
                tracing::warn!(%error, "what can be read is shown");
            }
        }
        Ok(())
    }

    /// Returns whether the store is opened for reading alone.
    pub fn is_read_only(&self) -> bool {
        self.is_read_only
    }

    /// Returns the handle of the writer.
    pub fn writer(&self) -> &Writer {
        &self.writer
    }

    /// Stores all facts that were sent before, then closes the store.
    pub async fn close(&self) {
        // The readers close first, because the last connection merges the write-ahead log into the file.
        self.reader.pool.close().await;
        self.writer.close().await;
    }

    /// Returns the sizes of the file and of its write-ahead log `[bytes]`; `None` for a server.
    pub fn sizes_bytes(&self) -> Option<[u64; 2]> {
        let file = self.file.as_ref()?;
        let log = PathBuf::from(format!("{}-wal", file.display()));
        Some([file, &log].map(|file| std::fs::metadata(file).map_or(0, |file| file.len())))
    }

    /// Returns the number of this start of the coordinator on this store.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Returns a reader of the store.
    pub fn reader(&self) -> Reader {
        self.reader.clone()
    }
}

/// Seconds from 1970 to 2026.
const EPOCHS_FROM_S: i64 = 1_767_225_600;

/// Numbers this start by the clock, but always above every earlier start.
async fn begin_epoch(connection: &mut Connection, now_ms: i64) -> Result<u64, sqlx::Error> {
    let epoch: i64 = query_scalar(
        "INSERT INTO epochs (epoch, started_at_ms)
         VALUES (max(?, 1 + (SELECT coalesce(max(epoch), 0) FROM epochs)), ?) RETURNING epoch",
    )
    .bind(now_ms / 1000 - EPOCHS_FROM_S)
    .bind(now_ms)
    .fetch_one(connection)
    .await?;
    Ok(epoch.unsigned_abs())
}
