//! Backup of a store, also while a coordinator writes to it.

use std::fs::{File, OpenOptions};
use std::path::Path;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::query;

/// The reason why there is no backup.
#[derive(Debug, thiserror::Error)]
pub enum BackupError {
    /// The store cannot be read, or its copy cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The file cannot be created.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
}

impl Reader {
    /// Writes the store as it is at one moment to a new file, without deleted rows. Returns the size of the file `[bytes]`.
    ///
    /// The name is reserved first, so that nothing is overwritten. The copy gets the name when it is complete and on disk.
    ///
    /// # Errors
    /// [`BackupError`]; the incomplete file is removed.
    pub async fn back_up(&self, to: &Path) -> Result<u64, BackupError> {
        let partial = to.with_added_extension("part");
        let failed = |path: &Path| {
            let path = path.display().to_string();
            move |source| BackupError::File { path, source }
        };
        // A store holds hashes of tokens and unpublished measurements, so only the owner may read its copy.
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
            // The error that is reported is the cause, even if the copy cannot be removed either.
            let _ = std::fs::remove_file(&partial);
            let _ = std::fs::remove_file(to);
        }
        copied
    }

    async fn copy_to(&self, file: &Path) -> Result<(), StoreError> {
        let name = file.display().to_string();
        let copied = query("VACUUM INTO ?").bind(&name).execute(&self.pool).await;
        copied.map(drop).map_err(|source| StoreError::new(&name, source))
    }
}
