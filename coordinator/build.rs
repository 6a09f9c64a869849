//! Names the build by its sources, so that results stored by another build are computed again.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// Everything that a result is made by.
const SOURCES: [&str; 9] = [
    "src",
    "page",
    "discovery/src",
    "inference/src",
    "job/src",
    "record/src",
    "result/src",
    "../shared",
    "../Cargo.lock",
];

fn main() -> std::io::Result<()> {
    let mut hasher = DefaultHasher::new();
    for source in SOURCES {
        println!("cargo:rerun-if-changed={source}");
        hash(Path::new(source), &mut hasher)?;
    }
    println!("cargo:rustc-env=GROUSER_BUILD={:016x}", hasher.finish());
    Ok(())
}

fn hash(path: &Path, hasher: &mut DefaultHasher) -> std::io::Result<()> {
    if !path.is_dir() {
        path.hash(hasher);
        std::fs::read(path)?.hash(hasher);
        return Ok(());
    }
    let mut inside: Vec<_> = std::fs::read_dir(path)?.collect::<Result<_, _>>()?;
    inside.sort_by_key(std::fs::DirEntry::file_name);
    inside.iter().try_for_each(|entry| hash(&entry.path(), hasher))
}
