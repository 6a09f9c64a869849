//! A copy of a store while a coordinator may be writing to it.

use std::fs::{File, OpenOptions};
use std::path::Path;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::query;

/// Why there is no backup.
#[derive(Debug, thiserror::Error)]
pub enum BackupError {
    /// The store cannot be read, or its copy not be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The file cannot be made.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// What the operating system says.
        source: std::io::Error,
    },
}

impl Reader {
    /// Writes the store as it is at one moment to a new file, without what was deleted; its size `[bytes]`.
    ///
    /// The name is taken first, so that nothing is overwritten; it stands for the copy when that is complete and on disk.
    ///
    /// # Errors
    /// [`BackupError`]; what was begun is removed.
    pub async fn back_up(&self, to: &Path) -> Result<u64, BackupError> {
        let partial = to.with_added_extension("part");
        let failed = |path: &Path| {
            let path = path.display().to_string();
            move |source| BackupError::File { path, source }
        };
        // A store holds hashes of tokens and unpublished measurements: its copy is the owner's alone.
        let make = |path: &Path| {
            let mut options = OpenOptions::new();
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
            options.write(true).create_new(true).open(path)
        };
        make(to).map_err(failed(to))?;
        if let Err(source) = make(&partial) {
            let _ = std::fs::remove_file(to);
            return Err(failed(&partial)(source));
        }
        let copied = async {
            self.copy_to(&partial).await?;
            let file = File::open(&partial).map_err(failed(&partial))?;
            file.sync_all().map_err(failed(&partial))?;
            let bytes = file.metadata().map_err(failed(&partial))?.len();
            std::fs::rename(&partial, to).map_err(failed(to))?;
            Ok(bytes)
        };
        let copied = copied.await;
        if copied.is_err() {
            // The error that is told is the cause, even if the copy cannot be removed either.
            let _ = std::fs::remove_file(&partial);
            let _ = std::fs::remove_file(to);
        }
        copied
    }

    async fn copy_to(&self, file: &Path) -> Result<(), StoreError> {
        let name = file.display().to_string();
        let copied = query("VACUUM INTO ?").bind(&name).execute(&self.pool).await;
        copied.map(drop).map_err(|source| StoreError::of(&name, source))
    }
}
