//! A store opened beside the program, as any client of SQLite or PostgreSQL opens it.

use sqlx::{AnyConnection, AssertSqlSafe, Connection};
use tokio::runtime::Runtime;

/// A connection of its own to a store.
#[derive(Debug)]
pub struct Database {
    runtime: Runtime,
    connection: AnyConnection,
}

impl Database {
    /// Opens a store by the name that `--store` takes.
    ///
    /// # Panics
    /// It is no database.
    #[track_caller]
    pub fn open(store: &str) -> Database {
        sqlx::any::install_default_drivers();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .expect("a runtime");
        let connection = runtime.block_on(AnyConnection::connect(store));
        Database {
            runtime,
            connection: connection.expect("a database"),
        }
    }

    /// Executes statements.
    ///
    /// # Panics
    /// The database refuses.
    #[track_caller]
    pub fn execute(&mut self, sql: &str) {
        let statements = sqlx::raw_sql(AssertSqlSafe(sql));
        let done = self.runtime.block_on(statements.execute(&mut self.connection));
        done.unwrap_or_else(|e| panic!("{sql}: {e}"));
    }

    /// The number that a query gives.
    ///
    /// # Panics
    /// The database refuses, or there is none.
    #[track_caller]
    pub fn number(&mut self, sql: &str) -> i64 {
        let query = sqlx::query_scalar(AssertSqlSafe(sql));
        let number = self.runtime.block_on(query.fetch_one(&mut self.connection));
        number.unwrap_or_else(|e| panic!("{sql}: {e}"))
    }

    /// The text that a query gives.
    ///
    /// # Panics
    /// The database refuses, or there is none.
    #[track_caller]
    pub fn text(&mut self, sql: &str) -> String {
        let query = sqlx::query_scalar(AssertSqlSafe(sql));
        let text = self.runtime.block_on(query.fetch_one(&mut self.connection));
        text.unwrap_or_else(|e| panic!("{sql}: {e}"))
    }
}
