//! Packages of others: their sources, licences and duplicates, by the rules of deny.toml, and the bill of materials of a release.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use farm_tests::workspace::{root, text};
use serde_json::Value;

/// The largest number of packages of others that are built for the programs and their tests on one platform.
const MAX_PACKAGES: usize = 300;

/// Returns the packages of others that are built for this platform.
fn built() -> BTreeSet<String> {
    let words = "tree --workspace --edges normal,build,dev --prefix none --format {p} --offline --locked";
    let output = Command::new("cargo")
        .args(words.split(' '))
        .current_dir(root())
        .output();
    let output = output.expect("cargo");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let lines = String::from_utf8(output.stdout).expect("text");
    // A package of ours stands with its folder.
    let of_others = lines
        .lines()
        .filter(|line| !line.is_empty() && !line.contains("(/"));
    let name_and_version = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    of_others.map(name_and_version).collect()
}

/// Returns the packages of others that the lock file allows for this platform, as cargo describes them. Some are parts of others that ours
/// do not ask for, and are not built.
fn packages() -> Vec<Value> {
    let version = Command::new("rustc").arg("-vV").output().expect("a compiler");
    let version = String::from_utf8(version.stdout).expect("text");
    let host = version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .expect("a host");
    let output = Command::new("cargo")
        .args([
            "metadata",
            "--format-version",
            "1",
            "--locked",
            "--offline",
            "--filter-platform",
            host,
        ])
        .current_dir(root())
        .output()
        .expect("cargo");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let nodes = found["resolve"]["nodes"].as_array().expect("a graph");
    let resolved: BTreeSet<&str> = nodes.iter().filter_map(|node| node["id"].as_str()).collect();
    let packages = found["packages"].as_array().expect("packages").iter();
    let of_others = packages
        .filter(|package| package["id"].as_str().is_some_and(|id| resolved.contains(id)))
        .filter(|package| !package["source"].is_null());
    of_others.cloned().collect()
}

fn rules() -> toml::Table {
    toml::from_str(&text(&root().join("deny.toml"))).expect("TOML")
}

fn list(rules: &toml::Table, table: &str, key: &str) -> BTreeSet<String> {
    let values = rules[table][key].as_array().expect("a list");
    values
        .iter()
        .map(|value| value.as_str().expect("a text").to_owned())
        .collect()
}

/// Returns whether a licence expression can be met by allowed licences: each part joined by AND has an alternative that is allowed.
fn is_met(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let mut parts = expression.split(" AND ");
    parts.all(|part| {
        let part = part.trim_matches(['(', ')']).replace('/', " OR ");
        part.split(" OR ").any(|licence| allowed.contains(licence.trim()))
    })
}

#[test]
fn packages_of_others_come_from_one_registry_under_licences_that_are_allowed_and_are_few() {
    let (packages, rules) = (packages(), rules());
    let (registries, licences) = (
        list(&rules, "sources", "allow-registry"),
        list(&rules, "licenses", "allow"),
    );
    let mut versions: BTreeMap<&str, usize> = BTreeMap::new();
    for package in &packages {
        let name = package["name"].as_str().expect("a name");
        let source = package["source"].as_str().expect("a source");
        let registry = source.trim_start_matches("registry+");
        assert!(registries.contains(registry), "{name} comes from {source}");
        let licence = package["license"].as_str().unwrap_or_default();
        assert!(is_met(licence, &licences), "{name} has the licence {licence:?}");
        *versions.entry(name).or_default() += 1;
    }
    let twice = versions.iter().filter(|(_, count)| **count > 1);
    let twice: BTreeSet<String> = twice.map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(twice, list(&rules, "bans", "skip"), "packages in two versions");
    let built = built().len();
    assert!(
        (200..=MAX_PACKAGES).contains(&built),
        "{built} packages of others"
    );
}

#[test]
fn the_bill_of_materials_has_the_packages_of_the_programs_with_their_sums() {
    let output = Command::new(root().join("deploy/sbom"))
        .current_dir(root())
        .output()
        .expect("python3");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let bill: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(bill["bomFormat"], "CycloneDX");
    let components = bill["components"].as_array().expect("components");
    let has = |name: &str| components.iter().any(|component| component["name"] == name);
    assert!(has("axum") && has("sqlx") && !has("proptest") && !has("coordinator"));
    for component in components {
        let sum = component["hashes"][0]["content"].as_str().unwrap_or_default();
        assert_eq!(sum.len(), 64, "{component}");
        assert!(component["licenses"][0]["expression"].is_string(), "{component}");
    }
}
