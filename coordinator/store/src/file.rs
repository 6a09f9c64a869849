//! The file of a store: its name, its options, its lock, and the checks that refuse other files.

use std::io::Read;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};
use sqlx::{Connection as _, SqliteConnection, SqlitePool};

use super::error::StoreError;
use super::health::PATIENCE;
use super::migrations;
use super::sql::Connection;

/// Size of a page of a new file `[B]`. A row of a table without row ids that is longer than about a quarter of a page takes a page of its own.
/// Final draws on tens of runs have one to four thousand bytes: at SQLite's 4,096 B a page, a store would be three times as large.
/// Checked by `tests::rows_of_final_draws_share_pages`.
const PAGE_BYTES: u32 = 16_384;

/// Returns the file's name without the scheme.
pub fn file_of(path: &str) -> &str {
    path.strip_prefix("sqlite://").unwrap_or(path)
}

pub(super) fn options(path: &str) -> SqliteConnectOptions {
    // The file is given by its name and not by a URL, because a name may contain `%` or `?`.
    SqliteConnectOptions::new()
        .filename(file_of(path))
        .foreign_keys(true)
        .busy_timeout(PATIENCE)
}

/// Refuses a database that another program or a later version of this program has made.
pub(super) async fn recognise(connection: &mut SqliteConnection, path: &str) -> Result<(), StoreError> {
    let wrap = |source| StoreError::new(path, source);
    let ours = "SELECT count(*) FROM sqlite_schema WHERE name = '_sqlx_migrations' OR name = 'calibrations'";
    let supported: i64 = sqlx::query_scalar(ours)
        .fetch_one(&mut *connection)
        .await
        .map_err(wrap)?;
    let all: i64 = sqlx::query_scalar("SELECT count(*) FROM sqlite_schema")
        .fetch_one(&mut *connection)
        .await
        .map_err(wrap)?;
    if all == 0 {
        return Ok(());
    }
    if supported != 2 {
        return Err(StoreError::Unfit {
            path: file_of(path).into(),
            reason: "the database was not created by Grouser".into(),
        });
    }
    let found: Option<i64> = sqlx::query_scalar("SELECT max(version) FROM _sqlx_migrations")
        .fetch_one(connection)
        .await
        .map_err(wrap)?;
    let (found, supported) = (found.unwrap_or_default(), migrations::VERSION);
    if found > supported {
        let path = file_of(path).into();
        return Err(StoreError::Newer {
            path,
            found,
            supported,
        });
    }
    Ok(())
}

/// Opens a connection that may write.
pub(super) async fn connect(path: &str, may_create: bool) -> Result<Connection, StoreError> {
    let options = writing(path).create_if_missing(may_create);
    let connected = SqliteConnection::connect_with(&options).await;
    let mut connection = connected.map_err(|source| StoreError::new(path, source))?;
    recognise(&mut connection, path).await?;
    Ok(Connection::Sqlite(connection))
}

fn writing(path: &str) -> SqliteConnectOptions {
    options(path)
        .page_size(PAGE_BYTES)
        .journal_mode(SqliteJournalMode::Wal)
        .synchronous(SqliteSynchronous::Full)
}

pub(super) async fn pool(options: SqliteConnectOptions) -> Result<SqlitePool, sqlx::Error> {
    SqlitePoolOptions::new()
        .max_connections(4)
        .connect_with(options)
        .await
}

/// Refuses a file that cannot be a store before anything is written beside it.
pub(super) fn examine(path: &str) -> Result<(), StoreError> {
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
                Ok(_) => unfit("the file is not an SQLite database".into()),
                Err(error) => unfit(error.to_string()),
            }
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound && folder.is_dir() => Ok(()),
        Err(error) => unfit(error.to_string()),
    }
}

/// Takes the lock file beside the store. The lock is released when the returned file is dropped, or when the process dies.
///
/// The lock file is named after the file itself, even where a symbolic link leads to it. A file with several hard links is refused: SQLite
/// names the write-ahead log after the file, so facts that were acknowledged under one name would be missing under the other.
pub(super) fn lock(path: &str) -> Result<Option<std::fs::File>, StoreError> {
    let file = file_of(path);
    if file.contains(":memory:") {
        return Ok(None);
    }
    let io = |e: std::io::Error| StoreError::Database {
        path: file.into(),
        source: sqlx::Error::Io(e),
    };
    // A store holds hashes of tokens, keys of seals and unpublished measurements, so only its owner may read it. SQLite gives the files
    // beside it the same mode. The mode of an existing store is kept.
    let make = |name: &str| {
        let mut options = std::fs::OpenOptions::new();
        options.create(true).append(true).mode(0o600).open(name)
    };
    // A link may lead to a file that does not exist yet. An existing file is not opened, because closing it would release locks of this
    // process.
    let found = std::fs::metadata(file).or_else(|_| make(file).and_then(|made| made.metadata()));
    let names = found.map_err(io)?.nlink();
    if names > 1 {
        return Err(StoreError::Unfit {
            path: file.into(),
            reason: format!(
                "the file has {names} names (hard links), and each would have a write-ahead log of its own; keep one of them"
            ),
        });
    }
    let target = std::fs::canonicalize(file).map_err(io)?;
    let lock = make(&format!("{}.lock", target.display())).map_err(io)?;
    match lock.try_lock() {
        Ok(()) => Ok(Some(lock)),
        Err(std::fs::TryLockError::WouldBlock) => Err(StoreError::InUse(file.into())),
        Err(std::fs::TryLockError::Error(e)) => Err(io(e)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn rows_of_final_draws_share_pages() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grouser.db").display().to_string();
        let options = writing(&path).create_if_missing(true);
        let mut connection = SqliteConnection::connect_with(&options).await.unwrap();
        let run = "CREATE TABLE draws (id INTEGER PRIMARY KEY, observables BLOB) WITHOUT ROWID";
        sqlx::query(run).execute(&mut connection).await.unwrap();
        // The observables of a final draw on 40 runs.
        let (rows, bytes) = (500, 1400);
        for id in 0..rows {
            let row = sqlx::query("INSERT INTO draws VALUES (?, zeroblob(?))").bind(id);
            row.bind(bytes).execute(&mut connection).await.unwrap();
        }
        let size = "SELECT page_count * page_size FROM pragma_page_count(), pragma_page_size()";
        let size: i64 = sqlx::query_scalar(size).fetch_one(&mut connection).await.unwrap();
        let content = rows * bytes;
        assert!(size < content * 3 / 2, "{size} bytes hold {content}");
    }
}
