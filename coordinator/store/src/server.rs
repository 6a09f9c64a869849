//! A store in a PostgreSQL server: its connections, its lock, and the checks that refuse other databases.

use std::str::FromStr;
use std::time::Duration;

use sqlx::postgres::{PgConnectOptions, PgPoolOptions};
use sqlx::{Connection as _, PgConnection, PgPool};

use super::error::StoreError;
use super::migrations;
use super::place::name_of;
use super::sql::{Connection, query, query_scalar};

/// How often an idle writer checks whether its connection still exists.
pub(super) const PROBE: Duration = Duration::from_secs(2);
/// The time within which the server must answer a check of the connection. After this time, the connection counts as lost.
pub(super) const ANSWER_TIME: Duration = Duration::from_secs(5);
/// The time within which the server must store a group of facts, which takes milliseconds. After this time, the connection counts as
/// lost.
pub(super) const GROUP_TIME: Duration = Duration::from_secs(30);

/// Awaits the result of a statement. Returns an error if it takes longer than `max`.
pub(super) async fn in_time<T>(
    max: Duration,
    statement: impl Future<Output = Result<T, sqlx::Error>>,
) -> Result<T, sqlx::Error> {
    let late = |_| sqlx::Error::Io(std::io::Error::from(std::io::ErrorKind::TimedOut));
    tokio::time::timeout(max, statement).await.map_err(late)?
}

/// The time without a statement after which the coordinator that holds the lock counts as gone.
const SILENCE: Duration = Duration::from_secs(7);
/// The same time while it upgrades the tables, because an upgrade computes between the statements of a transaction.
const SILENCE_IN_UPGRADE: Duration = Duration::from_secs(60);

/// The name of our connections in the server.
const NAME: &str = "grouser";
/// The name of the connection that upgrades the tables.
const UPGRADE_NAME: &str = "grouser upgrade";

/// The number of the lock that the one writer of a database holds: the letters of "grouser".
const LOCK: i64 = 0x67_72_6f_75_73_65_72;

/// Settings with which a server soon detects that a machine is gone: probes after 2 s, three of them a second apart, and at most 5 s until
/// data that the server sent itself is acknowledged, because it does not probe meanwhile.
const SETTINGS: [(&str, &str); 4] = [
    ("tcp_keepalives_idle", "2"),
    ("tcp_keepalives_interval", "1"),
    ("tcp_keepalives_count", "3"),
    ("tcp_user_timeout", "5000"),
];

fn options(path: &str) -> Result<PgConnectOptions, StoreError> {
    let options = PgConnectOptions::from_str(path).map_err(|source| StoreError::new(path, source))?;
    Ok(options.application_name(NAME).options(SETTINGS))
}

/// Opens a connection that may write.
pub(super) async fn connect(path: &str) -> Result<Connection, StoreError> {
    let connected = PgConnection::connect_with(&options(path)?).await;
    let mut connection = Connection::Postgres(connected.map_err(|source| StoreError::new(path, source))?);
    // An acknowledged commit must be on disk, whatever the server's default is.
    let durable = query("SET synchronous_commit = on")
        .execute(&mut connection)
        .await;
    durable.map_err(|source| StoreError::new(path, source))?;
    Ok(connection)
}

/// Opens a pool of connections that read.
pub(super) async fn pool(path: &str) -> Result<PgPool, StoreError> {
    let options = options(path)?;
    // A pool would repeat for half a minute an attempt that the server refuses at once.
    let first = PgConnection::connect_with(&options).await;
    let closed = first
        .map_err(|source| StoreError::new(path, source))?
        .close()
        .await;
    closed.map_err(|source| StoreError::new(path, source))?;
    Ok(PgPoolOptions::new().max_connections(4).connect_lazy_with(options))
}

/// Takes the lock of the one writer. Returns whether it was free. The server releases it when the connection ends. All writes go through
/// the same connection, so a process that has lost the lock cannot write.
pub(super) async fn lock(connection: &mut Connection, path: &str) -> Result<bool, StoreError> {
    let taken = query_scalar("SELECT pg_try_advisory_lock(?)").bind(LOCK);
    taken
        .fetch_one(connection)
        .await
        .map_err(|source| StoreError::new(path, source))
}

/// Gives the connection the name of one that upgrades the tables, or takes this name back.
///
/// # Errors
/// The database's error.
pub(super) async fn name_upgrade(connection: &mut PgConnection, is_upgrade: bool) -> Result<(), sqlx::Error> {
    let name = if is_upgrade { UPGRADE_NAME } else { NAME };
    let named = sqlx::query("SELECT set_config('application_name', $1, false)").bind(name);
    named.execute(connection).await.map(drop)
}

/// Ends the connection that holds the lock of the one writer, if its coordinator has been silent for [`SILENCE`]: it is halted, or no
/// network leads to it. Returns whether one was ended.
///
/// A coordinator that lives sends a statement every [`PROBE`], and the server knows when the last one ended. A connection that is at work
/// is left alone, and one that upgrades the tables for [`SILENCE_IN_UPGRADE`]. A coordinator can be halted within a transaction as well as
/// between two. One that wakes up later finds its connection and its lock gone, and ends.
pub(super) async fn end_silent_holder(connection: &mut Connection, path: &str) -> Result<bool, StoreError> {
    let ended = query_scalar(
        "SELECT pg_terminate_backend(a.pid) FROM pg_locks l JOIN pg_stat_activity a ON a.pid = l.pid
         WHERE l.locktype = 'advisory' AND l.granted AND l.objsubid = 1
         AND l.database = (SELECT oid FROM pg_database WHERE datname = current_database())
         AND l.classid::bigint = ? AND l.objid::bigint = ?
         AND a.state LIKE 'idle%'
         AND a.state_change < now() - make_interval(secs => CASE a.application_name WHEN ? THEN ?::float8 ELSE ?::float8 END)",
    );
    let ended: Vec<bool> = ended
        .bind(LOCK >> 32)
        .bind(LOCK & 0xffff_ffff)
        .bind(UPGRADE_NAME)
        .bind(SILENCE_IN_UPGRADE.as_secs_f64())
        .bind(SILENCE.as_secs_f64())
        .fetch_all(connection)
        .await
        .map_err(|source| StoreError::new(path, source))?;
    Ok(ended.contains(&true))
}

/// Refuses a database that another program or a later version of this program has made.
pub(super) async fn recognise(connection: &mut Connection, path: &str) -> Result<(), StoreError> {
    let wrap = |source| StoreError::new(path, source);
    // An interrupted first start may leave an empty table of migrations. Views are ignored, because this program makes none.
    let tables = "SELECT count(*) FROM information_schema.tables
                  WHERE table_schema = current_schema() AND table_type = 'BASE TABLE' AND table_name <> '_sqlx_migrations'";
    let all: i64 = query_scalar(tables)
        .fetch_one(&mut *connection)
        .await
        .map_err(wrap)?;
    if all == 0 {
        return Ok(());
    }
    let ours = "SELECT count(*) FROM information_schema.tables WHERE table_schema = current_schema()
                AND table_name IN ('_sqlx_migrations', 'calibrations')";
    let supported: i64 = query_scalar(ours)
        .fetch_one(&mut *connection)
        .await
        .map_err(wrap)?;
    if supported != 2 {
        return Err(StoreError::Unfit {
            path: name_of(path),
            reason: "the database has tables that Grouser did not create".into(),
        });
    }
    let found = query_scalar("SELECT max(version) FROM _sqlx_migrations");
    let found: Option<i64> = found.fetch_one(connection).await.map_err(wrap)?;
    let (found, supported) = (found.unwrap_or_default(), migrations::VERSION);
    match found > supported {
        true => Err(StoreError::Newer {
            path: name_of(path),
            found,
            supported,
        }),
        false => Ok(()),
    }
}
