//! A store, opened by a client of SQLite or PostgreSQL beside the program.

use sqlx::{Any, AnyConnection, AssertSqlSafe, Connection, Decode, Type};
use tokio::runtime::Runtime;

/// A connection to a store.
#[derive(Debug)]
pub struct Database {
    runtime: Runtime,
    connection: AnyConnection,
}

impl Database {
    /// Opens a store by its value of `--store`.
    #[track_caller]
    pub fn open(store: &str) -> Database {
        sqlx::any::install_default_drivers();
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.expect("a runtime");
        let connection = runtime.block_on(AnyConnection::connect(store));
        Database {
            runtime,
            connection: connection.expect("a database"),
        }
    }

    /// Executes statements.
    #[track_caller]
    pub fn execute(&mut self, sql: &str) {
        let statements = sqlx::raw_sql(AssertSqlSafe(sql));
        let done = self.runtime.block_on(statements.execute(&mut self.connection));
        done.unwrap_or_else(|e| panic!("{sql}: {e}"));
    }

    /// Returns the number that a query returns.
    #[track_caller]
    pub fn number(&mut self, sql: &str) -> i64 {
        self.scalar(sql)
    }

    /// Returns the text that a query returns.
    #[track_caller]
    pub fn text(&mut self, sql: &str) -> String {
        self.scalar(sql)
    }

    #[track_caller]
    fn scalar<T>(&mut self, sql: &str) -> T
    where
        T: for<'r> Decode<'r, Any> + Type<Any> + Send + Unpin,
    {
        let query = sqlx::query_scalar(AssertSqlSafe(sql));
        let value = self.runtime.block_on(query.fetch_one(&mut self.connection));
        value.unwrap_or_else(|e| panic!("{sql}: {e}"))
    }
}
