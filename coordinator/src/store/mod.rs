//! The SQLite file: the only place that knows SQL.
//!
//! One task writes (`writer`); everybody else reads through a pool of their own. What the tables mean stands
//! in `migrations/README.md`.

mod blob;
mod facts;
mod prior;
mod read;
mod recovery;
mod writer;

use std::io::Read;
use std::path::Path;

use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};
use sqlx::{Connection, SqliteConnection, SqlitePool};

pub use writer::{FactSink, NewCalibrationRow, NewStudy, StoreHealth, StudyIds, Writer};

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
    #[error("the store no longer takes writes; the coordinator is going down")]
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

impl From<sqlx::Error> for StoreError {
    fn from(source: sqlx::Error) -> Self {
        StoreError::Sqlite {
            path: "query".into(),
            source,
        }
    }
}

/// The store: a pool of readers and the way to the one writer.
#[derive(Debug, Clone)]
pub struct Store {
    readers: SqlitePool,
    writer: Writer,
    epochs: Vec<u64>,
}

/// The file's name without the scheme.
fn file_of(path: &str) -> &str {
    path.strip_prefix("sqlite://").unwrap_or(path)
}

fn options(path: &str) -> SqliteConnectOptions {
    // By file name, not by URL: a name may hold a `%` or a `?`.
    SqliteConnectOptions::new()
        .filename(file_of(path))
        .foreign_keys(true)
        .busy_timeout(std::time::Duration::from_secs(2))
}

/// Refuses a database that somebody else has made.
async fn recognise(connection: &mut SqliteConnection, path: &str) -> Result<(), StoreError> {
    let ours = "SELECT count(*) FROM sqlite_schema WHERE name = '_sqlx_migrations' OR name = 'calibrations'";
    let known: i64 = sqlx::query_scalar(ours).fetch_one(&mut *connection).await?;
    let all: i64 = sqlx::query_scalar("SELECT count(*) FROM sqlite_schema")
        .fetch_one(connection)
        .await?;
    if known == 2 || all == 0 {
        return Ok(());
    }
    Err(StoreError::Unfit {
        path: file_of(path).into(),
        reason: "the database is not one of Grouser's".into(),
    })
}

impl Store {
    /// Opens the file, makes it if need be, brings its tables up to date, starts the writer and a new epoch.
    ///
    /// # Errors
    /// [`StoreError`] with the file and SQLite's reason; [`StoreError::InUse`] where another coordinator holds it.
    pub async fn open(path: &str, now_ms: i64) -> Result<Store, StoreError> {
        let wrap = |source| StoreError::Sqlite {
            path: path.into(),
            source,
        };
        examine(path)?;
        // The writer holds its lock file for as long as it lives; a second coordinator is turned away at once.
        let lock = lock(path)?;
        let options = options(path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Full);
        let mut connection = SqliteConnection::connect_with(&options).await.map_err(wrap)?;
        recognise(&mut connection, path).await?;
        sqlx::migrate!("../migrations")
            .run(&mut connection)
            .await
            .map_err(|source| StoreError::Migrate {
                path: path.into(),
                source,
            })?;
        let epochs = begin_epoch(&mut connection, now_ms).await.map_err(wrap)?;
        let readers = pool(options).await.map_err(wrap)?;
        let writer = Writer::start(connection, lock);
        Ok(Store {
            readers,
            writer,
            epochs,
        })
    }

    /// The way to the writer.
    pub fn writer(&self) -> &Writer {
        &self.writer
    }

    /// Stores what was told before and closes the file.
    pub async fn close(&self) {
        // Readers first: the last connection folds the write-ahead log into the file.
        self.readers.close().await;
        self.writer.close().await;
    }

    /// Numbers of the coordinator's starts on this store, the present one included.
    pub fn epochs(&self) -> &[u64] {
        &self.epochs
    }

    /// What can be read.
    pub fn reader(&self) -> Reader {
        Reader {
            pool: self.readers.clone(),
        }
    }
}

/// Reads a store, also one that another process is writing.
#[derive(Debug, Clone)]
pub struct Reader {
    pool: SqlitePool,
}

impl Reader {
    /// Opens an existing file for reading alone.
    ///
    /// # Errors
    /// [`StoreError`] with the file and the reason.
    pub async fn open(path: &str) -> Result<Reader, StoreError> {
        let file = file_of(path);
        if !Path::new(file).is_file() {
            return Err(StoreError::Missing(file.into()));
        }
        examine(path)?;
        let pool = pool(options(path).read_only(true))
            .await
            .map_err(|source| StoreError::Sqlite {
                path: path.into(),
                source,
            })?;
        recognise(&mut *pool.acquire().await?, path).await?;
        Ok(Reader { pool })
    }
}

/// Numbers as a JSON array; every finite `f64` comes back to the bit.
fn json<T: serde::Serialize + ?Sized>(values: &T) -> String {
    serde_json::to_string(values).expect("numbers have a JSON form")
}

/// The numbers of a JSON array.
fn numbers(json: &str) -> Result<Vec<f64>, StoreError> {
    serde_json::from_str(json).map_err(|e| StoreError::Corrupt(format!("parameter vector {json}: {e}")))
}

/// Seconds from 1970 to 2026.
const EPOCHS_FROM_S: i64 = 1_767_225_600;

/// Numbers this start by the clock, but above every start before: so two stores never share an epoch. All of them.
async fn begin_epoch(connection: &mut SqliteConnection, now_ms: i64) -> Result<Vec<u64>, sqlx::Error> {
    sqlx::query(
        "INSERT INTO epochs (epoch, started_at_ms)
         VALUES (max(?, 1 + (SELECT coalesce(max(epoch), 0) FROM epochs)), ?)",
    )
    .bind(now_ms / 1000 - EPOCHS_FROM_S)
    .bind(now_ms)
    .execute(&mut *connection)
    .await?;
    let epochs: Vec<i64> = sqlx::query_scalar("SELECT epoch FROM epochs ORDER BY epoch")
        .fetch_all(connection)
        .await?;
    Ok(epochs.into_iter().map(i64::unsigned_abs).collect())
}

async fn pool(options: SqliteConnectOptions) -> Result<SqlitePool, sqlx::Error> {
    SqlitePoolOptions::new()
        .max_connections(4)
        .connect_with(options)
        .await
}

/// Refuses what cannot be a store before anything is written beside it.
fn examine(path: &str) -> Result<(), StoreError> {
    let file = Path::new(file_of(path));
    if path.contains(":memory:") {
        return Ok(());
    }
    let unfit = |reason: String| {
        Err(StoreError::Unfit {
            path: file.display().to_string(),
            reason,
        })
    };
    let folder = file
        .parent()
        .filter(|f| !f.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    match std::fs::File::open(file) {
        Ok(open) if !open.metadata().is_ok_and(|m| m.is_file()) => unfit("this is no file".into()),
        Ok(mut open) => {
            let mut head = Vec::new();
            match open.by_ref().take(16).read_to_end(&mut head) {
                Ok(_) if head.is_empty() || head == b"SQLite format 3\0" => Ok(()),
                Ok(_) => unfit("the file is not a database of SQLite".into()),
                Err(error) => unfit(error.to_string()),
            }
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound && folder.is_dir() => Ok(()),
        Err(error) => unfit(error.to_string()),
    }
}

/// Takes the lock file beside the store; it is released when the returned file is dropped, or at any death.
fn lock(path: &str) -> Result<Option<std::fs::File>, StoreError> {
    let file = file_of(path);
    if file.contains(":memory:") {
        return Ok(None);
    }
    let name = format!("{file}.lock");
    let io = |e: std::io::Error| StoreError::Sqlite {
        path: name.clone(),
        source: sqlx::Error::Io(e),
    };
    let lock = std::fs::OpenOptions::new()
        .create(true)
        .truncate(false)
        .write(true)
        .open(&name)
        .map_err(io)?;
    match lock.try_lock() {
        Ok(()) => Ok(Some(lock)),
        Err(std::fs::TryLockError::WouldBlock) => Err(StoreError::InUse(file.into())),
        Err(std::fs::TryLockError::Error(e)) => Err(io(e)),
    }
}
