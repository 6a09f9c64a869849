//! The imports between the modules of the page, and between those of the Python package.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use farm_tests::workspace::{files, root, text};

/// The files of a folder by their paths below it, with their texts.
pub(super) type Sources = BTreeMap<String, String>;

/// The files that each file imports.
pub(super) type Imports = BTreeMap<String, BTreeSet<String>>;

/// Returns every source of a folder of the workspace whose name ends with a suffix.
pub(super) fn sources(folder: &str, suffix: &str) -> Sources {
    let below = root().join(folder);
    let named = |path: PathBuf| {
        let relative = path.strip_prefix(&below).expect("a file of the folder");
        (relative.display().to_string(), text(&path))
    };
    files(folder, suffix).into_iter().map(named).collect()
}

/// Returns the static and dynamic imports of ES modules by relative paths, which must name files of the folder.
#[track_caller]
pub(super) fn module_imports(sources: &Sources) -> Imports {
    let edges = sources.iter().map(|(file, text)| {
        let code = without_comments(text);
        let named = ["from \"", "import \"", "import(\""].into_iter();
        let named = named.flat_map(|before| {
            code.split(before)
                .skip(1)
                .filter_map(|rest| rest.split('"').next())
        });
        let targets = named.filter_map(|path| below(file, path));
        let targets: BTreeSet<String> = targets.collect();
        for target in &targets {
            assert!(
                sources.contains_key(target),
                "{file} imports {target}, which does not exist"
            );
        }
        (file.clone(), targets)
    });
    edges.collect()
}

/// Returns the path of a module that a file names relative to itself; `None` for a module outside the folder.
fn below(file: &str, path: &str) -> Option<String> {
    if !path.starts_with('.') {
        return None;
    }
    let mut parts: Vec<&str> = file.split('/').collect();
    parts.pop();
    for component in Path::new(path).components() {
        match component {
            Component::ParentDir => {
                parts.pop()?;
            }
            Component::Normal(part) => parts.push(part.to_str()?),
            _ => {}
        }
    }
    Some(parts.join("/"))
}

/// Returns the code of a module without its comments, which may name types of other modules that are not imported at run time.
fn without_comments(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("/*") {
        code += before;
        rest = after.split_once("*/").map_or("", |(_, behind)| behind);
    }
    code += rest;
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the imports of a Python package by relative names, including those inside functions and those for types alone. `from . import
/// A, B` imports the modules A and B, or the package itself where a name is not a module.
pub(super) fn package_imports(sources: &Sources) -> Imports {
    let module = |name: &str| {
        let file = format!("{}.py", name.replace('.', "/"));
        sources.contains_key(&file).then_some(file)
    };
    let edges = sources.iter().map(|(file, text)| {
        let mut targets = BTreeSet::new();
        for line in on_one_line(text).lines() {
            let statement = line.trim_start().strip_prefix("from .");
            let Some((from, names)) = statement.and_then(|rest| rest.split_once(" import ")) else {
                continue;
            };
            let names = names.split('#').next().unwrap_or_default();
            let names = names
                .split(',')
                .map(|name| name.trim_matches(|c: char| "() ".contains(c)));
            let names = names.filter(|name| !name.is_empty());
            match from {
                "" => {
                    targets.extend(names.map(|name| module(name).unwrap_or_else(|| "__init__.py".to_owned())))
                }
                from => targets.extend(module(from)),
            }
        }
        targets.remove(file);
        (file.clone(), targets)
    });
    edges.collect()
}

/// Returns a text with each parenthesised import on one line.
fn on_one_line(text: &str) -> String {
    let mut joined = String::new();
    let mut is_open = false;
    for line in text.lines() {
        is_open |= line.contains(" import (");
        is_open &= !line.contains(')');
        joined += line;
        joined.push(if is_open { ' ' } else { '\n' });
    }
    joined
}
