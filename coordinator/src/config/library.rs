//! Where libraries that belong to this program lie.

use std::path::{Path, PathBuf};

/// Returns the places of a library: beside this program, where a build puts it, and in `../lib/grouser`, where a package does.
///
/// # Errors
/// The system does not tell where this program lies.
pub fn beside_program(library: &str) -> std::io::Result<[PathBuf; 2]> {
    let program = std::env::current_exe()?;
    let folder = program.parent().unwrap_or(Path::new("."));
    Ok([folder.join(library), folder.join("../lib/grouser").join(library)])
}
