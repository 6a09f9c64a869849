//! The disk of the store, which can be filled and emptied.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Size of the tmpfs.
const SIZE_MIB: usize = 96;

/// A disk.
#[derive(Debug)]
pub(super) struct Disk {
    folder: PathBuf,
    /// Whether a tmpfs is mounted there, which needs a superuser. The disk is never filled without one.
    is_mounted: bool,
    pub(super) is_full: bool,
}

impl Disk {
    /// Creates a folder and mounts the disk there.
    pub(super) fn new(folder: PathBuf) -> Disk {
        std::fs::create_dir(&folder).expect("a folder for the store");
        let size = format!("size={SIZE_MIB}m");
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", &size, "chaos"]).arg(&folder);
        let mounted = mount.stdout(Stdio::null()).stderr(Stdio::null()).status();
        Disk {
            folder,
            is_mounted: mounted.is_ok_and(|status| status.success()),
            is_full: false,
        }
    }

    /// Returns the store's file.
    pub(super) fn store(&self) -> PathBuf {
        self.folder.join("grouser.db")
    }

    /// Fills the disk except for a number of bytes.
    pub(super) fn fill(&mut self, free: usize) {
        self.is_full = self.is_mounted;
        if self.is_mounted {
            let mut ballast = File::create(self.folder.join("ballast")).expect("a file of the disk");
            while ballast.write_all(&[0; 4096]).is_ok() {}
            let length = ballast.metadata().expect("a file").len();
            let shorter = ballast.set_len(length.saturating_sub(free as u64));
            shorter.expect("a file becomes shorter");
        }
    }

    /// Empties the disk again.
    pub(super) fn empty(&mut self) {
        if std::mem::take(&mut self.is_full) {
            std::fs::remove_file(self.folder.join("ballast")).expect("the disk was filled");
        }
    }

    /// Replaces the store by a copy.
    pub(super) fn restore(&self, copy: &Path) {
        let store = self.store();
        for end in ["-wal", "-shm"] {
            // The call fails if the coordinator has closed the store, which removes these files.
            let _ = std::fs::remove_file(format!("{}{end}", store.display()));
        }
        std::fs::copy(copy, store).expect("the backup is put back");
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        if self.is_mounted {
            // The option defers the unmount until the last process with an open file has ended.
            let _ = Command::new("umount").arg("--lazy").arg(&self.folder).status();
        }
    }
}
