//! The imports between the files of a crate, each followed to the file that defines what it names.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Item, UseTree};

use farm_tests::workspace::{files, root, text};

/// The largest number of names and re-exports that are followed from one path.
const DEPTH: usize = 16;

/// A file of a crate as a module.
#[derive(Default)]
struct Module {
    /// Its path in the workspace.
    file: String,
    /// The names that it defines.
    defined: BTreeSet<String>,
    /// The names that it brings into scope, each with its path from the crate's root.
    imported: BTreeMap<String, Vec<String>>,
    /// Modules that it brings into scope as a whole.
    globs: Vec<Vec<String>>,
    /// Every path of two or more words in its code.
    named: BTreeSet<Vec<String>>,
}

/// The modules of a crate by their paths from its root.
pub(super) struct Crate(BTreeMap<Vec<String>, Module>);

impl Crate {
    /// Reads the sources below a folder.
    pub(super) fn read(folder: &str) -> Self {
        let below = root().join(folder);
        // A program beside a library is a crate of its own.
        let roots: &[&str] = if below.join("lib.rs").is_file() {
            &["mod", "lib"]
        } else {
            &["mod", "main"]
        };
        let module = |file: PathBuf| {
            let relative = file.strip_prefix(&below).expect("a file of the folder");
            let path = module_path(relative, roots);
            let source = syn::parse_file(&text(&file)).expect("the compiler reads it, too");
            let mut module = Module {
                file: format!("{folder}/{}", relative.display()),
                ..Module::default()
            };
            for item in source.items.iter().filter(|item| !is_test(item)) {
                module.take(item, &path);
            }
            (path, module)
        };
        Self(files(folder, ".rs").into_iter().map(module).collect())
    }

    /// Returns the files that each file imports.
    pub(super) fn imports(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let edges = self.0.iter().map(|(path, module)| {
            let imported = module.imported.values();
            let imported = imported.filter_map(|absolute| self.definition(&[], absolute, DEPTH));
            let named = module.named.iter();
            let named = named.filter_map(|relative| self.definition(path, relative, DEPTH));
            let globs = module.globs.iter().filter(|glob| self.0.contains_key(*glob));
            let targets = imported.chain(named).chain(globs.cloned());
            let targets = targets.map(|target| self.0[&target].file.as_str());
            let file = module.file.as_str();
            (file, targets.filter(|target| *target != file).collect())
        });
        edges.collect()
    }

    /// Returns the module that defines the item of a path in another module; `None` for items of other crates and for
    /// modules.
    fn definition(&self, at: &[String], path: &[String], depth: usize) -> Option<Vec<String>> {
        let (first, rest) = path.split_first()?;
        let depth = depth.checked_sub(1)?;
        match first.as_str() {
            "crate" => return self.definition(&[], rest, depth),
            "self" => return self.definition(at, rest, depth),
            "super" => return self.definition(at.split_last()?.1, rest, depth),
            _ => {}
        }
        let child: Vec<String> = at.iter().chain([first]).cloned().collect();
        if self.0.contains_key(&child) {
            return self.definition(&child, rest, depth);
        }
        let module = self.0.get(at)?;
        if module.defined.contains(first) {
            return Some(at.to_vec());
        }
        if let Some(target) = module.imported.get(first) {
            let whole: Vec<String> = target.iter().chain(rest).cloned().collect();
            return self.definition(&[], &whole, depth);
        }
        let globs = module.globs.iter();
        let mut found = globs.filter_map(|glob| self.definition(glob, path, depth));
        found.next()
    }
}

impl Module {
    fn take(&mut self, item: &Item, at: &[String]) {
        let name = match item {
            Item::Use(import) => return self.import(&import.tree, &mut Vec::new(), at),
            Item::Struct(item) => Some(&item.ident),
            Item::Enum(item) => Some(&item.ident),
            Item::Trait(item) => Some(&item.ident),
            Item::Type(item) => Some(&item.ident),
            Item::Const(item) => Some(&item.ident),
            Item::Static(item) => Some(&item.ident),
            Item::Fn(item) => Some(&item.sig.ident),
            _ => None,
        };
        self.defined.extend(name.map(ToString::to_string));
        self.paths(item.to_token_stream());
    }

    /// Takes the leaves of a `use` as paths from the crate's root; no module has the paths of other crates.
    fn import(&mut self, tree: &UseTree, before: &mut Vec<String>, at: &[String]) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.import(&path.tree, before, at);
                before.pop();
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(tree, before, at);
                }
            }
            UseTree::Glob(_) => self.globs.extend(absolute(before, at)),
            UseTree::Name(name) => self.leaf(&name.ident.to_string(), &name.ident.to_string(), before, at),
            UseTree::Rename(name) => self.leaf(&name.ident.to_string(), &name.rename.to_string(), before, at),
        }
    }

    fn leaf(&mut self, name: &str, scope: &str, before: &[String], at: &[String]) {
        let mut path = before.to_vec();
        let mut scope = scope.to_owned();
        if name == "self" {
            scope = before.last().cloned().unwrap_or_default();
        } else {
            path.push(name.to_owned());
        }
        if let Some(path) = absolute(&path, at) {
            self.imported.insert(scope, path);
        }
    }

    /// Takes every path of two or more words out of code, including the code in macro calls.
    fn paths(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(word) => {
                    if colons != 2 {
                        self.end(&mut path);
                    }
                    path.push(word.to_string());
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                TokenTree::Group(group) => {
                    self.end(&mut path);
                    self.paths(group.stream());
                    colons = 0;
                }
                _ => {
                    self.end(&mut path);
                    colons = 0;
                }
            }
        }
        self.end(&mut path);
    }

    fn end(&mut self, path: &mut Vec<String>) {
        let path = std::mem::take(path);
        if path.len() > 1 {
            self.named.insert(path);
        }
    }
}

/// Returns the path from the crate's root that a path in the module `at` means; `None` for an empty path.
fn absolute(path: &[String], at: &[String]) -> Option<Vec<String>> {
    let mut absolute = at.to_vec();
    let mut words = path.iter().peekable();
    match words.next()?.as_str() {
        "crate" => absolute.clear(),
        "self" => {}
        "super" => drop(absolute.pop()),
        first => absolute.push(first.to_owned()),
    }
    while words.next_if(|word| *word == "super").is_some() {
        absolute.pop();
    }
    absolute.extend(words.cloned());
    Some(absolute)
}

/// Returns the path of a module; a file with one of the names `roots` is the module of its folder.
fn module_path(relative: &Path, roots: &[&str]) -> Vec<String> {
    let words = relative.with_extension("");
    let words = words.iter().map(|word| word.to_string_lossy().into_owned());
    let mut words: Vec<String> = words.collect();
    words.pop_if(|last| roots.contains(&last.as_str()));
    words
}

fn is_test(item: &Item) -> bool {
    let attributes = match item {
        Item::Mod(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Const(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        _ => return false,
    };
    let mut texts = attributes.iter().map(|a| a.to_token_stream().to_string());
    texts.any(|text| text.contains("cfg") && text.contains("test"))
}
