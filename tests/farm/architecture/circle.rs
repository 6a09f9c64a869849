//! No two files of a crate import each other, directly or through others.

use std::collections::{BTreeMap, BTreeSet};

use super::import::Crate;
use super::script::{self, Imports, Sources};

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
fn circles(imports: &BTreeMap<&str, BTreeSet<&str>>) -> Vec<String> {
    let reached = reached(imports);
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

/// A circle of imports among scripts.
fn script_circles(imports: &Imports) -> Vec<String> {
    let borrowed = imports
        .iter()
        .map(|(file, targets)| (file.as_str(), targets.iter().map(String::as_str).collect()));
    circles(&borrowed.collect())
}

#[test]
fn no_files_import_each_other() {
    let folders = super::CRATES.iter().filter(|krate| **krate != "tests");
    let folders = folders.map(|krate| format!("{krate}/src"));
    let benches = ["coordinator/farm/benches/simulation", "tests/harness"].map(str::to_owned);
    let found: Vec<String> = folders
        .chain(benches)
        .flat_map(|folder| circles(&Crate::read(&folder).imports()))
        .collect();
    assert!(found.is_empty(), "circles of imports:\n{}", found.join("\n"));
}

#[test]
fn imports_are_followed_to_where_things_are_defined() {
    let files = Crate::read("coordinator/farm/src");
    let imports = files.imports();
    let edges: usize = imports.values().map(BTreeSet::len).sum();
    assert!(
        imports.len() > 25 && edges > 2 * imports.len(),
        "{} files, {edges} imports",
        imports.len()
    );
    // The rules of leases are imported through names of other modules, too.
    let importers = imports
        .iter()
        .filter(|(_, targets)| targets.contains("coordinator/farm/src/lease/queue/mod.rs"))
        .map(|(file, _)| *file);
    let importers: Vec<&str> = importers.collect();
    let is_found = |file: &str| importers.iter().any(|importer| importer.ends_with(file));
    assert!(
        is_found("src/calibration/second_answer.rs") && is_found("src/farm.rs"),
        "{importers:?}"
    );
}

#[test]
fn no_modules_of_the_page_and_of_the_package_import_each_other() {
    let page = script::of_modules(&script::sources("coordinator/page/modules", ".js"));
    let package = script::of_package(&script::sources("python/src/grouser", ".py"));
    for (imports, files, edges) in [(&page, 60, 200), (&package, 15, 40)] {
        let count: usize = imports.values().map(BTreeSet::len).sum();
        assert!(
            imports.len() > files && count > edges,
            "{} files, {count} imports",
            imports.len()
        );
    }
    let found = [script_circles(&page), script_circles(&package)].concat();
    assert!(found.is_empty(), "circles of imports:\n{}", found.join("\n"));
}

#[test]
fn a_planted_circle_of_scripts_is_found() {
    let sources = |files: &[(&str, &str)]| -> Sources {
        files
            .iter()
            .map(|&(file, text)| (file.to_owned(), text.to_owned()))
            .collect()
    };
    let page = sources(&[
        ("page.js", "const later = () => import(\"./view/a.js\");\n"),
        (
            "view/a.js",
            "import { b } from \"../part/b.js\";\nimport { html } from \"../../vendor/preact.js\";\n",
        ),
        (
            "part/b.js",
            "/** @param {import(\"../view/a.js\").A} a */\nexport const b = (a) => a;\n",
        ),
    ]);
    assert_eq!(script_circles(&script::of_modules(&page)), Vec::<String>::new());
    let closed = [
        page.clone(),
        sources(&[("part/b.js", "import {\n  a,\n} from \"../view/a.js\";\n")]),
    ];
    let closed = closed.into_iter().flatten().collect();
    assert_eq!(
        script_circles(&script::of_modules(&closed)),
        ["part/b.js -> view/a.js", "view/a.js -> part/b.js", ""]
    );
    let package = sources(&[
        ("__init__.py", "from ._a import A\n"),
        ("_a.py", "from . import _b\n"),
        (
            "_b.py",
            "import numpy\n\nif TYPE_CHECKING:\n    from ._c import (\n        C,\n    )\n",
        ),
        ("_c.py", "def c():\n    from . import (\n        _a,\n    )\n"),
    ]);
    assert_eq!(
        script_circles(&script::of_package(&package)),
        ["_a.py -> _b.py", "_b.py -> _c.py", "_c.py -> _a.py", ""]
    );
}
