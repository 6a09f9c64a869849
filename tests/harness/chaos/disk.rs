//! The disk that a store lies on: one that can be filled and emptied.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Size of a disk of our own.
const SIZE_MIB: usize = 96;
/// What a file is filled with.
const BLOCK: usize = 4096;

/// A disk.
#[derive(Debug)]
pub(super) struct Disk {
    folder: PathBuf,
    /// Whether a file system of our own is mounted there, which only a superuser may do. Elsewhere the size of the
    /// coordinator's files is limited (`RLIMIT_FSIZE`, without its signal): SQLite finds that it cannot write, too.
    pub(super) is_mounted: bool,
    pub(super) is_full: bool,
}

impl Disk {
    /// A disk at a folder, which is made.
    pub(super) fn at(folder: PathBuf) -> Disk {
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

    /// The store's file.
    pub(super) fn store(&self) -> PathBuf {
        self.folder.join("grouser.db")
    }

    /// Fills the disk but for so many bytes; `writer` is the process that writes to it.
    pub(super) fn fill(&mut self, free: usize, writer: Option<u32>) {
        self.is_full = self.is_mounted || writer.is_some();
        if !self.is_mounted {
            let Some(writer) = writer else { return };
            return limit(writer, &free.to_string());
        }
        let mut ballast = File::create(self.folder.join("ballast")).expect("a file of the disk");
        while ballast.write_all(&[0; BLOCK]).is_ok() {}
        let length = ballast.metadata().expect("a file").len();
        let less = length.saturating_sub(free as u64);
        ballast.set_len(less).expect("a file becomes shorter");
    }

    /// Empties the disk again.
    pub(super) fn empty(&mut self, writer: Option<u32>) {
        self.is_full = false;
        match (self.is_mounted, writer) {
            (true, _) => drop(std::fs::remove_file(self.folder.join("ballast"))),
            (false, Some(writer)) => limit(writer, "unlimited"),
            (false, None) => {}
        }
    }

    /// Puts a copy of a store in place of the store.
    pub(super) fn put_back(&self, copy: &Path) {
        let store = self.store();
        for end in ["-wal", "-shm"] {
            // Where the coordinator has closed the store, they are gone.
            let _ = std::fs::remove_file(format!("{}{end}", store.display()));
        }
        std::fs::copy(copy, store).expect("the backup is put back");
    }
}

/// Limits the size of the files of a process `[bytes]`; of one that has ended nothing is limited.
fn limit(process: u32, bytes: &str) {
    let mut command = Command::new("prlimit");
    command.args([format!("--pid={process}"), format!("--fsize={bytes}:")]);
    let _ = command
        .stderr(Stdio::null())
        .status()
        .expect("util-linux is installed");
}

impl Drop for Disk {
    fn drop(&mut self) {
        if self.is_mounted {
            // A process that still ends keeps it for so long.
            let _ = Command::new("umount").arg("--lazy").arg(&self.folder).status();
        }
    }
}

/// The same command, told of a full disk by an error of its writes and not by a signal.
pub(super) fn without_signal(command: &Command) -> Command {
    let mut other = Command::new("sh");
    other.args(["-c", "trap '' XFSZ; exec \"$0\" \"$@\""]);
    other
        .arg(command.get_program())
        .args(command.get_args())
        .stdin(Stdio::null());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => other.env(name, value),
            None => other.env_remove(name),
        };
    }
    other
}
