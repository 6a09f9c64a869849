//! Reads a store through a pool of connections.

use std::path::Path;

use sqlx::SqlitePool;

use super::error::StoreError;
use super::file::{examine, file_of, options, pool, recognise};

/// Reads a store, also one that another process is writing.
#[derive(Debug, Clone)]
pub struct Reader {
    pub(super) pool: SqlitePool,
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
