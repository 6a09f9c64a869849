//! Opening of a store for writing.

use std::fs::File;
use std::time::{Duration, Instant};

use super::error::StoreError;
use super::health::PATIENCE;
use super::place::{is_server, name_of};
use super::sql::Connection;
use super::{damage, file, members, migrations, server};

/// The time between two attempts to take the lock of a server.
const ASK_AGAIN: Duration = Duration::from_millis(100);

/// A connection that may write, with the lock that keeps other writers out.
struct Opened {
    connection: Connection,
    /// The lock of a file; the lock of a server belongs to the connection.
    lock: Option<File>,
    /// Whether no other program holds the store.
    is_free: bool,
}

/// Opens a store for its one writer, and brings its tables up to date.
///
/// # Errors
/// [`StoreError::InUse`] where another coordinator holds the store; else the database's error.
pub(super) async fn to_write(path: &str) -> Result<(Connection, Option<File>), StoreError> {
    let mut opened = open(path, true).await?;
    if let Connection::Sqlite(connection) = &mut opened.connection {
        damage::check(connection, path).await?;
    }
    migrate(&mut opened.connection, path).await?;
    Ok((opened.connection, opened.lock))
}

/// Opens a store for short changes beside a coordinator that may hold it. If none does, the tables are brought up to date, and no
/// coordinator can start until the connection is dropped.
///
/// # Errors
/// The database's error.
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
        // The server may not have noticed yet that the previous coordinator has died.
        let end = Instant::now() + PATIENCE;
        while is_alone && !is_free {
            if Instant::now() > end {
                return Err(StoreError::InUse(name_of(path)));
            }
            if server::end_silent_holder(&mut connection, path).await? {
                tracing::warn!(
                    store = name_of(path),
                    "the coordinator that held the store was silent; its connection is ended"
                );
            }
            tokio::time::sleep(ASK_AGAIN).await;
            is_free = server::lock(&mut connection, path).await?;
        }
        // The tables are examined after the lock is taken, because another coordinator may be creating them.
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
    name_upgrade(connection, path, true).await?;
    let migrated = match connection {
        Connection::Sqlite(connection) => migrations::migrator().run(connection).await,
        Connection::Postgres(connection) => migrations::server_migrator().run(connection).await,
    };
    migrated.map_err(|source| StoreError::from_migration(path, source))?;
    members::fill(connection, path).await?;
    name_upgrade(connection, path, false).await
}

async fn name_upgrade(connection: &mut Connection, path: &str, is_upgrade: bool) -> Result<(), StoreError> {
    if let Connection::Postgres(connection) = connection {
        let named = server::name_upgrade(connection, is_upgrade).await;
        named.map_err(|source| StoreError::new(path, source))?;
    }
    Ok(())
}
