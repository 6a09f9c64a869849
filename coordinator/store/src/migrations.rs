//! The store's tables, in the order in which they came about.

use sqlx::SqlSafeStr;
use sqlx::migrate::{Migration, MigrationType, Migrator};

/// Number, name and text of each file of `migrations/`.
///
/// They are listed here because the macro that lists them builds SQLite a second time, for the compiler.
const FILES: [(i64, &str, &str); 20] = [
    (
        1,
        "experiments",
        include_str!("../../../migrations/0001_experiments.sql"),
    ),
    (
        2,
        "calibrations",
        include_str!("../../../migrations/0002_calibrations.sql"),
    ),
    (
        3,
        "evaluations",
        include_str!("../../../migrations/0003_evaluations.sql"),
    ),
    (
        4,
        "estimates",
        include_str!("../../../migrations/0004_estimates.sql"),
    ),
    (
        5,
        "search estimates",
        include_str!("../../../migrations/0005_search_estimates.sql"),
    ),
    (
        6,
        "metamodel",
        include_str!("../../../migrations/0006_metamodel.sql"),
    ),
    (
        7,
        "discoveries",
        include_str!("../../../migrations/0007_discoveries.sql"),
    ),
    (
        8,
        "members experiment",
        include_str!("../../../migrations/0008_members_experiment.sql"),
    ),
    (
        9,
        "short evaluations",
        include_str!("../../../migrations/0009_short_evaluations.sql"),
    ),
    (
        10,
        "results",
        include_str!("../../../migrations/0010_results.sql"),
    ),
    (
        11,
        "seal keys",
        include_str!("../../../migrations/0011_seal_keys.sql"),
    ),
    (
        12,
        "disputes",
        include_str!("../../../migrations/0012_disputes.sql"),
    ),
    (
        13,
        "given up",
        include_str!("../../../migrations/0013_given_up.sql"),
    ),
    (14, "tokens", include_str!("../../../migrations/0014_tokens.sql")),
    (
        15,
        "removal",
        include_str!("../../../migrations/0015_removal.sql"),
    ),
    (
        16,
        "webhooks",
        include_str!("../../../migrations/0016_webhooks.sql"),
    ),
    (
        17,
        "effects",
        include_str!("../../../migrations/0017_effects.sql"),
    ),
    (
        18,
        "verification",
        include_str!("../../../migrations/0018_verification.sql"),
    ),
    (
        19,
        "repeats",
        include_str!("../../../migrations/0019_repeats.sql"),
    ),
    (
        20,
        "members",
        include_str!("../../../migrations/0020_members.sql"),
    ),
];

/// The same of `migrations/postgres/`: a server begins with the tables of version 19, and changes with the files of both.
const SERVER_FILES: [(i64, &str, &str); 2] = [
    (
        19,
        "store",
        include_str!("../../../migrations/postgres/0019_store.sql"),
    ),
    (
        20,
        "members",
        include_str!("../../../migrations/postgres/0020_members.sql"),
    ),
];

/// The version of the tables that this program writes.
pub(super) const VERSION: i64 = FILES[FILES.len() - 1].0;

/// Brings the tables of a file up to date.
pub(super) fn migrator() -> Migrator {
    of(&FILES)
}

/// Brings those in a server up to date.
pub(super) fn server_migrator() -> Migrator {
    of(&SERVER_FILES)
}

fn of(files: &[(i64, &'static str, &'static str)]) -> Migrator {
    let migration = |&(version, name, sql): &(i64, &'static str, &'static str)| {
        Migration::new(
            version,
            name.into(),
            MigrationType::Simple,
            sql.into_sql_str(),
            false,
        )
    };
    Migrator::with_migrations(files.iter().map(migration).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_listed(folder: &str, listed: &[(i64, &str, &str)]) {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.ends_with(".sql"))
            .collect();
        files.sort();
        let name =
            |(version, name, _): &(i64, &str, &str)| format!("{version:04}_{}.sql", name.replace(' ', "_"));
        let listed: Vec<String> = listed.iter().map(name).collect();
        assert_eq!(files, listed);
    }

    #[test]
    fn every_file_is_listed_under_its_number_and_name() {
        is_listed("../../migrations", &FILES);
        is_listed("../../migrations/postgres", &SERVER_FILES);
        let last = SERVER_FILES[SERVER_FILES.len() - 1].0;
        assert_eq!(last, VERSION, "both databases have the same tables");
    }
}
