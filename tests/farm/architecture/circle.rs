//! No two files of a crate import each other, directly or through others.

use std::collections::{BTreeMap, BTreeSet};

use super::import::Crate;

/// The files that each file reaches by imports.
fn reached<'a>(imports: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> BTreeMap<&'a str, BTreeSet<&'a str>> {
    let from = |start: &'a str| {
        let mut seen = BTreeSet::new();
        let mut next: Vec<&str> = imports[start].iter().copied().collect();
        while let Some(file) = next.pop() {
            if seen.insert(file) {
                next.extend(imports.get(file).into_iter().flatten());
            }
        }
        (start, seen)
    };
    imports.keys().map(|&start| from(start)).collect()
}

/// The groups of files in which each reaches every other, with the imports inside.
fn circles(folder: &str) -> Vec<String> {
    let files = Crate::read(folder);
    let imports = files.imports();
    let reached = reached(&imports);
    let mut found = Vec::new();
    let mut told = BTreeSet::new();
    for (&file, targets) in &reached {
        if !targets.contains(file) || told.contains(file) {
            continue;
        }
        let group: BTreeSet<&str> = targets
            .iter()
            .copied()
            .filter(|t| reached[t].contains(file))
            .collect();
        told.extend(group.iter().copied());
        for member in &group {
            let inside: Vec<&str> = imports[member].intersection(&group).copied().collect();
            found.push(format!("{member} -> {}", inside.join(", ")));
        }
        found.push(String::new());
    }
    found
}

#[test]
fn no_files_import_each_other() {
    let folders = super::CRATES.iter().filter(|krate| **krate != "tests");
    let folders = folders.map(|krate| format!("{krate}/src"));
    let benches = [
        "coordinator/benches/hidden_effect",
        "coordinator/benches/sbc",
        "coordinator/benches/simulation",
        "tests/harness",
    ]
    .map(str::to_owned);
    let found: Vec<String> = folders
        .chain(benches)
        .flat_map(|folder| circles(&folder))
        .collect();
    assert!(found.is_empty(), "circles of imports:\n{}", found.join("\n"));
}

#[test]
fn imports_are_followed_to_where_things_are_defined() {
    let files = Crate::read("coordinator/src");
    let imports = files.imports();
    let edges: usize = imports.values().map(BTreeSet::len).sum();
    assert!(
        imports.len() > 60 && edges > 2 * imports.len(),
        "{} files, {edges} imports",
        imports.len()
    );
    // The rules of leases are taken through other modules' names, too, and by calibration and farm alone.
    let importers = imports
        .iter()
        .filter(|(_, targets)| targets.contains("coordinator/src/lease/queue/mod.rs"))
        .map(|(file, _)| *file);
    let importers: Vec<&str> = importers.collect();
    let rooms = ["calibration", "farm", "lease"].map(|room| format!("coordinator/src/{room}/"));
    let alone = importers
        .iter()
        .all(|file| rooms.iter().any(|room| file.starts_with(room)));
    assert!(!importers.is_empty() && alone, "{importers:?}");
}
