//! Opens a store for writing.

use std::fs::File;
use std::time::{Duration, Instant};

use super::error::StoreError;
use super::health::PATIENCE;
use super::place::{is_server, name_of};
use super::sql::Connection;
use super::{damage, file, members, migrations, server};

/// How soon a lock of a server is asked for again.
const ASK_AGAIN: Duration = Duration::from_millis(100);

/// A connection that may write, and what keeps others from the store.
struct Opened {
    connection: Connection,
    /// The lock of a file; that of a server goes with the connection.
    lock: Option<File>,
    /// Whether nobody else holds the store.
    is_free: bool,
}

/// Opens a store for its one writer: whole, and with tables that are up to date.
///
/// # Errors
/// [`StoreError::InUse`] where another coordinator holds the store; else the database's reason.
pub(super) async fn to_write(path: &str) -> Result<(Connection, Option<File>), StoreError> {
    let mut opened = open(path, true).await?;
    if let Connection::Sqlite(connection) = &mut opened.connection {
        damage::check(connection, path).await?;
    }
    migrate(&mut opened.connection, path).await?;
    Ok((opened.connection, opened.lock))
}

/// Opens a store for short changes beside a coordinator that may hold it; where none does, its tables are brought up to date, and none
/// starts meanwhile.
///
/// # Errors
/// The database's reason.
pub(super) async fn beside(path: &str) -> Result<(Connection, Option<File>), StoreError> {
    let mut opened = open(path, false).await?;
    if opened.is_free {
        migrate(&mut opened.connection, path).await?;
    }
    Ok((opened.connection, opened.lock))
}

async fn open(path: &str, is_alone: bool) -> Result<Opened, StoreError> {
    if is_server(path) {
        let mut connection = server::connect(path).await?;
        let mut is_free = server::lock(&mut connection, path).await?;
        // The server may not have noticed yet that the coordinator before this one has died.
        let end = Instant::now() + PATIENCE;
        while is_alone && !is_free {
            if Instant::now() > end {
                return Err(StoreError::InUse(name_of(path)));
            }
            tokio::time::sleep(ASK_AGAIN).await;
            is_free = server::lock(&mut connection, path).await?;
        }
        // Behind the lock: another coordinator may be making the tables.
        server::recognise(&mut connection, path).await?;
        return Ok(Opened {
            connection,
            lock: None,
            is_free,
        });
    }
    file::examine(path)?;
    let (lock, is_free) = match file::lock(path) {
        Ok(lock) => (lock, true),
        Err(StoreError::InUse(_)) if !is_alone => (None, false),
        Err(error) => return Err(error),
    };
    Ok(Opened {
        connection: file::connect(path, is_free).await?,
        lock,
        is_free,
    })
}

async fn migrate(connection: &mut Connection, path: &str) -> Result<(), StoreError> {
    let migrated = match connection {
        Connection::Sqlite(connection) => migrations::migrator().run(connection).await,
        Connection::Postgres(connection) => migrations::server_migrator().run(connection).await,
    };
    migrated.map_err(|source| StoreError::of_migration(path, source))?;
    members::fill(connection, path).await
}
