//! The file of a store, opened beside the program as any SQLite client opens it.

use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{Connection, SqliteConnection};
use std::path::Path;
use tokio::runtime::Runtime;

/// A connection of its own to a store.
#[derive(Debug)]
pub struct Database {
    runtime: Runtime,
    connection: SqliteConnection,
}

impl Database {
    /// Opens the file of a store.
    ///
    /// # Panics
    /// It is no database.
    #[track_caller]
    pub fn open(file: &Path) -> Database {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .expect("a runtime");
        let options = SqliteConnectOptions::new().filename(file);
        let connection = runtime.block_on(SqliteConnection::connect_with(&options));
        Database {
            runtime,
            connection: connection.expect("a database"),
        }
    }

    /// Executes a statement.
    ///
    /// # Panics
    /// SQLite refuses.
    #[track_caller]
    pub fn execute(&mut self, sql: &'static str) {
        let done = self
            .runtime
            .block_on(sqlx::query(sql).execute(&mut self.connection));
        done.unwrap_or_else(|e| panic!("{sql}: {e}"));
    }

    /// The number that a query gives.
    ///
    /// # Panics
    /// SQLite refuses, or there is none.
    #[track_caller]
    pub fn number(&mut self, sql: &'static str) -> i64 {
        let number = self
            .runtime
            .block_on(sqlx::query_scalar(sql).fetch_one(&mut self.connection));
        number.unwrap_or_else(|e| panic!("{sql}: {e}"))
    }

    /// The text that a query about a row gives.
    ///
    /// # Panics
    /// SQLite refuses, or there is none.
    #[track_caller]
    pub fn text(&mut self, sql: &'static str, id: i64) -> String {
        let text = sqlx::query_scalar(sql).bind(id);
        let text = self.runtime.block_on(text.fetch_one(&mut self.connection));
        text.unwrap_or_else(|e| panic!("{sql}: {e}"))
    }
}
