//! The rules of the house, held by manifests, `use` lines and file sizes.

mod circle;
mod citation;
mod import;
mod script;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use farm_tests::workspace::{files, root, text};

const CRATES: [&str; 21] = [
    "shared",
    "shared/formula",
    "shared/signal",
    "shared/statistics",
    "coordinator",
    "coordinator/inference",
    "coordinator/discovery",
    "coordinator/export",
    "coordinator/farm",
    "coordinator/import",
    "coordinator/job",
    "coordinator/page",
    "coordinator/record",
    "coordinator/report",
    "coordinator/result",
    "coordinator/search",
    "coordinator/store",
    "benchmark",
    "worker",
    "worker/scm",
    "tests",
];
const OURS: [&str; 21] = [
    "shared",
    "formula",
    "signal",
    "statistics",
    "coordinator",
    "inference",
    "discovery",
    "export",
    "farm",
    "import",
    "job",
    "page",
    "record",
    "report",
    "result",
    "search",
    "store",
    "benchmark",
    "worker",
    "scm",
    "farm-tests",
];

/// The dependencies of a crate that its products are built from.
fn dependencies(krate: &str) -> BTreeSet<String> {
    let manifest = text(&root().join(krate).join("Cargo.toml"));
    let manifest: toml::Table = manifest.parse().expect("a manifest");
    let mut names = BTreeSet::new();
    for table in ["dependencies", "build-dependencies"] {
        names.extend(
            manifest
                .get(table)
                .and_then(toml::Value::as_table)
                .into_iter()
                .flat_map(|t| t.keys().cloned()),
        );
    }
    names
}

fn set(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|&n| n.to_owned()).collect()
}

/// The lines of a source file that are code, with their numbers; what stands below `#[cfg(test)]` is left out.
fn code(path: &Path) -> Vec<(usize, String)> {
    let source = text(path);
    let lines = source
        .lines()
        .enumerate()
        .take_while(|(_, line)| !line.trim_start().starts_with("#[cfg(test)]"));
    lines
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        // Quoted text is no code.
        .map(|(i, line)| (i + 1, line.split('"').step_by(2).collect()))
        .collect()
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root())
        .expect("a file of the workspace")
        .display()
        .to_string()
}

/// Whether `word` stands in `line` as a word of its own, so that `scm::` is not found in `my_scm::`.
fn names(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '.')
    })
}

/// Every place below `folders` where one of the words is named, outside the files that may.
fn strays(folders: &[&str], words: &[&str], allowed: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    let sources: Vec<PathBuf> = folders.iter().flat_map(|folder| files(folder, ".rs")).collect();
    assert!(!sources.is_empty(), "no source in {folders:?}");
    for path in sources {
        let name = relative(&path);
        if allowed
            .iter()
            .any(|a| name == *a || (a.ends_with('/') && name.starts_with(a)))
        {
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
fn the_search_finds_what_is_there_and_only_that() {
    assert!(names("use scm::Soil;", "scm::") && names("    scm::simulate()", "scm::"));
    assert!(!names("use my_scm::Soil;", "scm::") && !names("crate::scm::Soil", "scm::"));
    assert!(!strays(&["coordinator/src"], &["axum::"], &[]).is_empty());
    assert!(!strays(&["coordinator/store/src"], &["sqlx::"], &[]).is_empty());
    assert!(!strays(&["worker/src"], &["reqwest::"], &[]).is_empty());
}

#[test]
fn manifests_keep_the_direction_of_dependencies() {
    let ours = |krate: &str| -> BTreeSet<String> {
        dependencies(krate)
            .into_iter()
            .filter(|d| OURS.contains(&d.as_str()))
            .collect()
    };
    assert_eq!(ours("shared/formula"), set(&[]));
    assert_eq!(ours("shared/signal"), set(&[]));
    assert_eq!(ours("shared/statistics"), set(&[]));
    assert_eq!(ours("shared"), set(&["formula", "signal", "statistics"]));
    assert_eq!(ours("worker/scm"), set(&["formula", "signal"]));
    assert_eq!(ours("coordinator/inference"), set(&["statistics"]));
    assert_eq!(ours("coordinator/discovery"), set(&["inference", "statistics"]));
    assert_eq!(ours("coordinator/import"), set(&["formula", "shared"]));
    assert_eq!(
        ours("coordinator/job"),
        set(&["formula", "inference", "shared", "statistics"])
    );
    assert_eq!(ours("coordinator/page"), set(&[]));
    assert_eq!(
        ours("coordinator/record"),
        set(&["inference", "job", "shared", "statistics"])
    );
    assert_eq!(
        ours("coordinator/report"),
        set(&[
            "formula",
            "inference",
            "job",
            "page",
            "record",
            "result",
            "shared",
            "statistics"
        ])
    );
    assert_eq!(
        ours("coordinator/result"),
        set(&["inference", "job", "record", "shared", "signal", "statistics"])
    );
    assert_eq!(
        ours("coordinator/export"),
        set(&["inference", "job", "record", "result", "shared", "statistics"])
    );
    assert_eq!(
        ours("coordinator/search"),
        set(&[
            "discovery",
            "formula",
            "inference",
            "job",
            "record",
            "shared",
            "statistics"
        ])
    );
    assert_eq!(
        ours("coordinator/farm"),
        set(&["inference", "job", "record", "search", "shared", "statistics"])
    );
    assert_eq!(
        ours("coordinator/store"),
        set(&["inference", "job", "record", "shared", "statistics"])
    );
    assert_eq!(
        ours("worker"),
        set(&["formula", "scm", "shared", "signal", "statistics"])
    );
    assert_eq!(
        ours("coordinator"),
        set(&[
            "discovery",
            "export",
            "farm",
            "formula",
            "import",
            "inference",
            "job",
            "page",
            "record",
            "report",
            "result",
            "search",
            "shared",
            "signal",
            "statistics",
            "store",
            "worker"
        ])
    );
    for krate in CRATES {
        assert!(!ours(krate).contains("farm-tests"), "{krate} imports the tests");
        assert!(!ours(krate).contains("benchmark"), "{krate} imports the studies");
    }
}

#[test]
fn pure_crates_know_no_runtime_network_database_or_chance() {
    let impure = [
        "tokio",
        "axum",
        "sqlx",
        "reqwest",
        "rayon",
        "tracing",
        "anyhow",
        "clap",
        "indicatif",
    ];
    for krate in [
        "shared",
        "shared/formula",
        "shared/signal",
        "shared/statistics",
        "worker/scm",
        "coordinator/inference",
        "coordinator/discovery",
        "coordinator/export",
        "coordinator/import",
        "coordinator/job",
        "coordinator/page",
        "coordinator/record",
        "coordinator/report",
        "coordinator/result",
    ] {
        let dependencies = dependencies(krate);
        let found: Vec<&str> = impure.into_iter().filter(|d| dependencies.contains(*d)).collect();
        assert!(found.is_empty(), "{krate} imports {found:?}");
    }
    for krate in ["shared", "shared/formula", "shared/signal", "worker/scm"] {
        let dependencies = dependencies(krate);
        assert!(
            !dependencies.iter().any(|d| d.starts_with("rand")),
            "{krate} draws random numbers"
        );
    }
    nowhere(
        &[
            "shared/statistics/src",
            "coordinator/inference/src",
            "coordinator/discovery/src",
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
    // A worker takes the moves of a metamodel; nothing else that is statistical is its business.
    nowhere(
        &["worker/src"],
        &["statistics::"],
        &["worker/src/model/low_fidelity.rs", "worker/src/model/variant.rs"],
    );
    nowhere(
        &["shared/src"],
        &["statistics::"],
        &[
            "shared/src/model/low_fidelity.rs",
            "shared/src/model/metamodel.rs",
            "shared/src/exchange.rs",
        ],
    );
}

#[test]
fn axum_sql_and_http_clients_stay_in_their_rooms() {
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
fn pure_rooms_read_no_clock() {
    let pure = [
        "worker/scm/src",
        "coordinator/inference/src",
        "coordinator/discovery/src",
        "shared/src",
        "shared/statistics/src",
        "coordinator/farm/src/calibration",
        "coordinator/farm/src/lease",
        "coordinator/import/src",
        "coordinator/job/src",
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
        let found = code(&root().join(file))
            .into_iter()
            .filter(|(_, l)| clocks.iter().any(|c| l.contains(c)))
            .count();
        assert_eq!(found, 0, "{file} reads a clock");
    }
}

#[test]
fn files_are_small() {
    let mut sizes: Vec<(usize, String)> = CRATES
        .iter()
        .filter(|krate| !["coordinator", "worker"].contains(krate))
        .chain(&["coordinator/src", "worker/src"])
        .filter(|folder| root().join(folder).is_dir())
        .flat_map(|folder| files(folder, ".rs"))
        .map(|path| (text(&path).lines().count(), relative(&path)))
        .collect();
    sizes.sort();
    sizes.dedup();
    let (longest, name) = sizes.last().cloned().unwrap_or_default();
    assert!(longest <= 600, "{name} has {longest} lines");
    let median = sizes[sizes.len() / 2].0;
    assert!(median <= 150, "the median file has {median} lines");
    assert!(sizes.len() > 100, "only {} files were found", sizes.len());
}

#[test]
fn every_crate_takes_the_lints_of_the_workspace() {
    for krate in CRATES {
        let manifest = text(&root().join(krate).join("Cargo.toml"));
        assert!(manifest.contains("[lints]\nworkspace = true"), "{krate}");
    }
    let workspace = text(&root().join("Cargo.toml"));
    assert!(workspace.contains("unsafe_code = \"forbid\""));
    let code = CRATES.iter().flat_map(|krate| files(krate, ".rs"));
    let allows: Vec<String> = code
        .filter(|p| text(p).contains(concat!("#[", "allow(")))
        .map(|p| relative(&p))
        .collect();
    assert!(
        allows.is_empty(),
        "expect, with a reason, instead of allow in {allows:?}"
    );
}
