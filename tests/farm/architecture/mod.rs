//! The rules of the house, held by manifests, `use` lines and file sizes.

mod circle;
mod citation;
mod import;
mod script;
mod supply;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use farm_tests::workspace::{files, root, text};

/// The folder and the name of every crate of the workspace.
const CRATES: [(&str, &str); 24] = [
    ("shared", "shared"),
    ("shared/formula", "formula"),
    ("shared/signal", "signal"),
    ("shared/statistics", "statistics"),
    ("coordinator", "coordinator"),
    ("coordinator/inference", "inference"),
    ("coordinator/discovery", "discovery"),
    ("coordinator/equation", "equation"),
    ("coordinator/export", "export"),
    ("coordinator/farm", "farm"),
    ("coordinator/import", "import"),
    ("coordinator/job", "job"),
    ("coordinator/page", "page"),
    ("coordinator/prediction", "prediction"),
    ("coordinator/record", "record"),
    ("coordinator/report", "report"),
    ("coordinator/result", "result"),
    ("coordinator/search", "search"),
    ("coordinator/store", "store"),
    ("benchmark", "benchmark"),
    ("worker", "worker"),
    ("worker/fmu", "fmu"),
    ("worker/scm", "scm"),
    ("tests", "farm-tests"),
];

/// The dependencies that each crate may have on other crates of the workspace.
const DIRECTION: [(&str, &str); 22] = [
    ("shared/formula", ""),
    ("shared/signal", ""),
    ("shared/statistics", ""),
    ("shared", "formula signal"),
    ("worker/scm", "formula signal"),
    ("coordinator/inference", "statistics"),
    ("coordinator/discovery", "inference statistics"),
    ("coordinator/equation", ""),
    ("coordinator/import", "formula shared"),
    ("coordinator/job", "formula inference shared statistics"),
    ("coordinator/page", ""),
    (
        "coordinator/prediction",
        "inference job record result shared statistics",
    ),
    ("coordinator/record", "inference job shared"),
    (
        "coordinator/report",
        "formula inference job page prediction record result shared statistics",
    ),
    (
        "coordinator/result",
        "inference job record shared signal statistics",
    ),
    (
        "coordinator/export",
        "inference job prediction record result shared statistics",
    ),
    (
        "coordinator/search",
        "discovery equation formula inference job record shared statistics",
    ),
    (
        "coordinator/farm",
        "inference job record search shared statistics",
    ),
    ("coordinator/store", "inference job record shared statistics"),
    ("worker", "formula scm shared signal"),
    ("worker/fmu", "shared worker"),
    (
        "coordinator",
        "discovery export farm formula import inference job page prediction record report result search shared signal store worker",
    ),
];

/// Returns the dependencies of a crate that its products are built from.
fn dependencies(krate: &str) -> BTreeSet<String> {
    let manifest = text(&root().join(krate).join("Cargo.toml"));
    let manifest: toml::Table = manifest.parse().expect("a manifest");
    let tables = ["dependencies", "build-dependencies"].into_iter();
    let tables = tables.filter_map(|table| manifest.get(table)?.as_table());
    tables.flat_map(|table| table.keys().cloned()).collect()
}

/// Returns the lines of a source file that are code, with their numbers, without comments, quoted text and the part below `#[cfg(test)]`.
fn code(path: &Path) -> Vec<(usize, String)> {
    let source = text(path);
    let lines = source.lines().enumerate();
    lines
        .take_while(|(_, line)| !line.trim_start().starts_with("#[cfg(test)]"))
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(i, line)| (i + 1, line.split('"').step_by(2).collect()))
        .collect()
}

fn set(names: &str) -> BTreeSet<String> {
    names.split_whitespace().map(str::to_owned).collect()
}

fn relative(path: &Path) -> String {
    let path = path.strip_prefix(root()).expect("a file of the workspace");
    path.display().to_string()
}

/// Returns whether `line` has `word` at the start of a path, so that `scm::` is not found in `my_scm::`.
fn names(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '.')
    })
}

/// Returns every line below `folders` with one of the words, except in the allowed files.
fn strays(folders: &[&str], words: &[&str], allowed: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    let sources: Vec<PathBuf> = folders.iter().flat_map(|folder| files(folder, ".rs")).collect();
    assert!(!sources.is_empty(), "no source in {folders:?}");
    for path in sources {
        let name = relative(&path);
        let is_in = |file: &&str| name == **file || (file.ends_with('/') && name.starts_with(*file));
        if allowed.iter().any(is_in) {
            continue;
        }
        for (number, line) in code(&path) {
            if words.iter().any(|word| names(&line, word)) {
                found.push(format!("{name}:{number}: {}", line.trim()));
            }
        }
    }
    found
}

#[track_caller]
fn nowhere(folders: &[&str], words: &[&str], allowed: &[&str]) {
    let found = strays(folders, words, allowed);
    assert!(
        found.is_empty(),
        "{words:?} outside {allowed:?}:\n{}",
        found.join("\n")
    );
}

#[test]
fn the_search_finds_paths_and_nothing_else() {
    assert!(names("use scm::Soil;", "scm::") && names("    scm::simulate()", "scm::"));
    assert!(!names("use my_scm::Soil;", "scm::") && !names("crate::scm::Soil", "scm::"));
    assert!(!strays(&["coordinator/src"], &["axum::"], &[]).is_empty());
    assert!(!strays(&["coordinator/store/src"], &["sqlx::"], &[]).is_empty());
    assert!(!strays(&["worker/src"], &["reqwest::"], &[]).is_empty());
}

#[test]
fn manifests_keep_the_direction_of_dependencies() {
    let names: BTreeSet<String> = CRATES.iter().map(|(_, name)| (*name).to_owned()).collect();
    let internal = |krate: &str| &dependencies(krate) & &names;
    for (krate, allowed) in DIRECTION {
        assert_eq!(internal(krate), set(allowed), "{krate}");
    }
    for (krate, _) in CRATES {
        assert!(
            !internal(krate).contains("farm-tests"),
            "{krate} imports the tests"
        );
        assert!(
            !internal(krate).contains("benchmark"),
            "{krate} imports the studies"
        );
    }
}

#[test]
fn pure_crates_know_no_runtime_network_database_or_chance() {
    let impure = set("tokio axum sqlx reqwest rayon tracing anyhow clap indicatif");
    let pure = "shared shared/formula shared/signal shared/statistics worker/scm coordinator/inference coordinator/discovery \
        coordinator/equation coordinator/export coordinator/import coordinator/job coordinator/page coordinator/prediction coordinator/record coordinator/report coordinator/result";
    for krate in set(pure) {
        let found = &dependencies(&krate) & &impure;
        assert!(found.is_empty(), "{krate} imports {found:?}");
    }
    for krate in ["shared", "shared/formula", "shared/signal", "worker/scm"] {
        let draws = dependencies(krate).iter().any(|d| d.starts_with("rand"));
        assert!(!draws, "{krate} draws random numbers");
    }
    nowhere(
        &[
            "shared/statistics/src",
            "coordinator/inference/src",
            "coordinator/discovery/src",
            "coordinator/equation/src",
        ],
        &["rand::", "rand_chacha::"],
        &["shared/statistics/src/rng.rs"],
    );
    nowhere(
        &["worker/scm/src", "shared/formula/src", "shared/signal/src"],
        &["HashMap", "HashSet", "std::collections::HashMap"],
        &[],
    );
}

#[test]
fn the_coordinator_knows_no_physics_and_the_worker_in_one_file() {
    nowhere(&["coordinator/src"], &["scm::", "use scm"], &[]);
    nowhere(
        &["coordinator/src"],
        &["worker::"],
        &["coordinator/src/embedded.rs"],
    );
    nowhere(&["worker/src"], &["coordinator::"], &[]);
    // Workers know neither priors nor likelihoods.
    nowhere(&["worker/src", "shared/src"], &["statistics::"], &[]);
}

#[test]
fn axum_sql_and_http_clients_stay_in_their_modules() {
    nowhere(
        &["coordinator/src"],
        &["axum::", "utoipa_axum::", "tower_http::"],
        &["coordinator/src/http/"],
    );
    nowhere(&["coordinator/src", "coordinator/farm/src"], &["sqlx::"], &[]);
    for (krate, names) in [
        ("coordinator/farm", ["axum", "sqlx", "rayon"]),
        ("coordinator/store", ["axum", "clap", "rayon"]),
    ] {
        let found = names.map(|name| dependencies(krate).contains(name));
        assert_eq!(found, [false; 3], "{krate} imports one of {names:?}");
    }
    nowhere(
        &["coordinator/src", "worker/src"],
        &["reqwest::"],
        &[
            "worker/src/client.rs",
            "worker/src/external/umbridge.rs",
            "coordinator/src/command/place.rs",
            "coordinator/src/webhook.rs",
        ],
    );
    nowhere(
        &["coordinator/src", "worker/src"],
        &["anyhow::", "anyhow!", "bail!"],
        &[
            "coordinator/src/main.rs",
            "coordinator/src/command/",
            "worker/src/main.rs",
        ],
    );
    let settings = &["coordinator/src/config/", "worker/src/config.rs"];
    nowhere(
        &["coordinator/src", "worker/src", "shared/src"],
        &["std::env::", "env::var"],
        settings,
    );
}

#[test]
fn the_rules_of_leases_know_nothing_else() {
    nowhere(&["coordinator/farm/src/lease"], &["crate::"], &[]);
}

#[test]
fn pure_modules_read_no_clock() {
    let pure = [
        "worker/scm/src",
        "coordinator/inference/src",
        "coordinator/discovery/src",
        "coordinator/equation/src",
        "shared/src",
        "shared/statistics/src",
        "coordinator/farm/src/calibration",
        "coordinator/farm/src/lease",
        "coordinator/import/src",
        "coordinator/job/src",
        "coordinator/prediction/src",
        "coordinator/report/src",
        "coordinator/result/src",
        "coordinator/export/src",
        "coordinator/search/src",
        "coordinator/src/effect",
    ];
    let clocks = [
        "Instant::now",
        "SystemTime::now",
        "std::time::Instant::now",
        "std::time::SystemTime::now",
    ];
    nowhere(&pure, &clocks, &[]);
    for file in [
        "coordinator/farm/src/farm.rs",
        "coordinator/farm/src/leasing.rs",
        "coordinator/farm/src/verification.rs",
        "coordinator/farm/src/progress.rs",
    ] {
        let mut lines = code(&root().join(file)).into_iter();
        let reads = lines.any(|(_, line)| clocks.iter().any(|clock| line.contains(clock)));
        assert!(!reads, "{file} reads a clock");
    }
}

#[test]
fn files_are_small() {
    let sources: BTreeSet<PathBuf> = CRATES.iter().flat_map(|(krate, _)| files(krate, ".rs")).collect();
    let sizes = sources
        .iter()
        .map(|path| (text(path).lines().count(), relative(path)));
    let mut sizes: Vec<(usize, String)> = sizes.collect();
    sizes.sort();
    let (longest, name) = sizes.last().cloned().unwrap_or_default();
    assert!(longest <= 600, "{name} has {longest} lines");
    let median = sizes[sizes.len() / 2].0;
    assert!(median <= 150, "the median file has {median} lines");
    assert!(sizes.len() > 100, "only {} files were found", sizes.len());
}

#[test]
fn every_crate_takes_the_lints_of_the_workspace() {
    for (krate, _) in CRATES {
        let manifest = text(&root().join(krate).join("Cargo.toml"));
        // The one crate with a C interface states the lints of the workspace itself, with `unsafe_code` to be expected in one file.
        let own = krate == "worker/fmu" && manifest.contains("unsafe_code = \"deny\"");
        assert!(own || manifest.contains("[lints]\nworkspace = true"), "{krate}");
    }
    let workspace = text(&root().join("Cargo.toml"));
    assert!(workspace.contains("unsafe_code = \"forbid\""));
    let code = CRATES.iter().flat_map(|(krate, _)| files(krate, ".rs"));
    let is_unsafe = |path: &PathBuf| text(path).contains(concat!("unsafe", "_code,"));
    let expected: BTreeSet<String> = code
        .clone()
        .filter(is_unsafe)
        .map(|path| relative(&path))
        .collect();
    assert_eq!(expected, set("worker/fmu/src/interface.rs"));
    let allows = code.filter(|path| text(path).contains(concat!("#[", "allow(")));
    let allows: Vec<String> = allows.map(|path| relative(&path)).collect();
    assert!(
        allows.is_empty(),
        "expect, with a reason, instead of allow in {allows:?}"
    );
}
