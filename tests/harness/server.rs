//! Databases of a PostgreSQL server, one for each store, when an environment variable names a server.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::database::Database;

/// The environment variable with the server, as `postgres://USER@HOST:PORT`. The user must be able to create databases.
const VARIABLE: &str = "GROUSER_TEST_POSTGRES";

/// A database that is deleted when this value is dropped.
#[derive(Debug)]
pub struct ServerDatabase {
    server: String,
    name: String,
}

impl ServerDatabase {
    /// Creates an empty database; `None` if no server is named.
    pub fn new() -> Option<ServerDatabase> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let server = std::env::var(VARIABLE).ok()?;
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("grouser_{}_{number}", std::process::id());
        let database = ServerDatabase { server, name };
        database.administer(&format!("CREATE DATABASE {}", database.name));
        Some(database)
    }

    /// Returns the URL for `--store`.
    pub fn url(&self) -> String {
        format!("{}/{}", self.server, self.name)
    }

    /// Ends every connection to it, as a restart of the server does.
    pub fn end_connections(&self) {
        let name = &self.name;
        self.administer(&format!(
            "SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity WHERE datname = '{name}'"
        ));
    }

    fn administer(&self, sql: &str) {
        Database::open(&format!("{}/postgres", self.server)).execute(sql);
    }
}

impl Drop for ServerDatabase {
    fn drop(&mut self) {
        self.administer(&format!("DROP DATABASE {} WITH (FORCE)", self.name));
    }
}
