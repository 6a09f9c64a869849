//! A search for damage in the file when the store is opened.

use std::time::{Duration, Instant};

use sqlx::{AssertSqlSafe, SqliteConnection};

use super::error::{StoreError, primary_code};
use super::file::file_of;
use super::reader::Reader;
use super::sql::Pool;

/// The longest time that the check may take. Tables that it has not reached by then stay unchecked.
const BUDGET: Duration = Duration::from_secs(3);
/// The number of steps of SQLite between two checks of the time.
const STEPS: i32 = 10_000;
/// SQLite's result code for an interrupted statement.
const INTERRUPTED: u32 = 9;

/// Checks the pages and rows of every table, the large ones last, until [`BUDGET`] is spent.
///
/// # Errors
/// [`StoreError::Damaged`] with the first damaged table.
pub(super) async fn check(connection: &mut SqliteConnection, path: &str) -> Result<(), StoreError> {
    let wrap = |source| StoreError::new(path, source);
    let tables = tables(connection).await.map_err(wrap)?;
    let until = Instant::now() + BUDGET;
    let mut handle = connection.lock_handle().await.map_err(wrap)?;
    handle.set_progress_handler(STEPS, move || Instant::now() < until);
    drop(handle);
    let mut checked = Ok(());
    for table in tables {
        checked = check_table(connection, path, table).await;
        if checked.is_err() || Instant::now() >= until {
            break;
        }
    }
    connection
        .lock_handle()
        .await
        .map_err(wrap)?
        .remove_progress_handler();
    checked
}

/// Returns the names of all tables, the large ones last.
async fn tables(connection: &mut SqliteConnection) -> Result<Vec<String>, sqlx::Error> {
    let tables = "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%'
                  ORDER BY name = 'evaluations', name = 'samples', name";
    sqlx::query_scalar(tables).fetch_all(connection).await
}

impl Reader {
    /// Checks the pages and rows of every table of a file to the end. A server checks its pages itself.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] with the first damaged table.
    pub async fn check_pages(&self, path: &str) -> Result<(), StoreError> {
        let Pool::Sqlite(pool) = &self.pool else {
            return Ok(());
        };
        let mut connection = pool.acquire().await?;
        for table in tables(&mut connection).await? {
            check_table(&mut connection, path, table).await?;
        }
        Ok(())
    }
}

async fn check_table(connection: &mut SqliteConnection, path: &str, table: String) -> Result<(), StoreError> {
    let query = AssertSqlSafe(format!("PRAGMA quick_check(\"{table}\")"));
    let lines = sqlx::query_scalar::<_, String>(query).fetch_all(connection).await;
    let what = match lines {
        Ok(lines) => match lines.into_iter().find(|line| line != "ok") {
            None => return Ok(()),
            Some(first) => first,
        },
        Err(error) if primary_code(&error) == Some(INTERRUPTED) => {
            let seconds = BUDGET.as_secs();
            tracing::info!(
                store = path,
                table,
                seconds,
                "not checked for damage to its end: the time is up"
            );
            return Ok(());
        }
        Err(error) => error.to_string(),
    };
    Err(StoreError::Damaged {
        path: file_of(path).into(),
        table,
        what,
    })
}
