//! No two files of a crate import each other, directly or through others.

use std::collections::{BTreeMap, BTreeSet};

use super::import::Crate;
use super::script::{self, Imports, Sources};

/// Returns the files that each file reaches by imports.
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

/// Returns the groups of files in which each file reaches every other file, with the imports inside.
fn circles(imports: &BTreeMap<&str, BTreeSet<&str>>) -> Vec<String> {
    let reached = reached(imports);
    let mut found = Vec::new();
    let mut reported = BTreeSet::new();
    for (&file, targets) in &reached {
        if !targets.contains(file) || reported.contains(file) {
            continue;
        }
        let group = targets
            .iter()
            .copied()
            .filter(|target| reached[target].contains(file));
        let group: BTreeSet<&str> = group.collect();
        reported.extend(group.iter().copied());
        for member in &group {
            let inside: Vec<&str> = imports[member].intersection(&group).copied().collect();
            found.push(format!("{member} -> {}", inside.join(", ")));
        }
        found.push(String::new());
    }
    found
}

/// Returns the circles of imports among scripts.
fn script_circles(imports: &Imports) -> Vec<String> {
    let borrowed = imports
        .iter()
        .map(|(file, targets)| (file.as_str(), targets.iter().map(String::as_str).collect()));
    circles(&borrowed.collect())
}

#[test]
fn no_files_import_each_other() {
    let folders = super::CRATES.iter().filter(|(krate, _)| *krate != "tests");
    let folders = folders.map(|(krate, _)| format!("{krate}/src"));
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
    let count = imports.len();
    assert!(count > 25 && edges > 2 * count, "{count} files, {edges} imports");
    // These files import the rules of leases through re-exports of other modules.
    for file in ["calibration/second_answer.rs", "farm.rs"] {
        let targets = &imports[format!("coordinator/farm/src/{file}").as_str()];
        assert!(
            targets.contains("coordinator/farm/src/lease/queue/mod.rs"),
            "{file}: {targets:?}"
        );
    }
}

#[test]
fn no_modules_of_the_page_and_of_the_package_import_each_other() {
    let page = script::module_imports(&script::sources("coordinator/page/modules", ".js"));
    let package = script::package_imports(&script::sources("python/src/grouser", ".py"));
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
        let files = files.iter();
        files
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
    assert_eq!(
        script_circles(&script::module_imports(&page)),
        Vec::<String>::new()
    );
    let mut closed = page;
    closed.insert(
        "part/b.js".into(),
        "import {\n  a,\n} from \"../view/a.js\";\n".into(),
    );
    assert_eq!(
        script_circles(&script::module_imports(&closed)),
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
        script_circles(&script::package_imports(&package)),
        ["_a.py -> _b.py", "_b.py -> _c.py", "_c.py -> _a.py", ""]
    );
}
