//! Backups of a store, the newest first.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use crate::programs;

/// So many are kept.
const KEPT: usize = 3;

/// The last backups.
#[derive(Debug)]
pub(super) struct Backups {
    folder: PathBuf,
    files: VecDeque<PathBuf>,
}

impl Backups {
    /// No backup yet; they go into a folder.
    pub(super) fn new(folder: &Path) -> Backups {
        Backups {
            folder: folder.to_owned(),
            files: VecDeque::new(),
        }
    }

    /// Copies a store that may be in use, unless its disk does not let the program.
    pub(super) fn make(&mut self, store: &Path, number: u64) {
        let copy = self.folder.join(format!("backup-{number}.db"));
        let store = format!("sqlite://{}", store.display());
        let words = [
            "backup".as_ref(),
            copy.as_os_str(),
            "--store".as_ref(),
            store.as_ref(),
        ];
        if programs::run(programs::coordinator(words)).code == Some(0) {
            self.files.push_front(copy);
        }
        for old in self.files.drain(self.files.len().min(KEPT)..) {
            std::fs::remove_file(old).expect("a backup is there");
        }
    }

    /// So many before the newest, or the oldest.
    pub(super) fn before_newest(&self, age: usize) -> Option<&Path> {
        let last = self.files.len().checked_sub(1)?;
        Some(&self.files[age.min(last)])
    }
}
