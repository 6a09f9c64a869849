//! The migrations of the store's tables, in order.

use sqlx::SqlSafeStr;
use sqlx::migrate::{Migration, MigrationType, Migrator};

/// A file of `migrations/`.
macro_rules! file {
    ($number:literal, $name:literal, $path:literal) => {
        (
            $number,
            $name,
            include_str!(concat!("../../../migrations/", $path)),
        )
    };
}

/// Number, name and text of each file of `migrations/`.
///
/// The files are listed here because sqlx's macro would build SQLite a second time, for the compiler.
const FILES: &[(i64, &str, &str)] = &[
    file!(1, "experiments", "0001_experiments.sql"),
    file!(2, "calibrations", "0002_calibrations.sql"),
    file!(3, "evaluations", "0003_evaluations.sql"),
    file!(4, "estimates", "0004_estimates.sql"),
    file!(5, "search estimates", "0005_search_estimates.sql"),
    file!(6, "metamodel", "0006_metamodel.sql"),
    file!(7, "discoveries", "0007_discoveries.sql"),
    file!(8, "members experiment", "0008_members_experiment.sql"),
    file!(9, "short evaluations", "0009_short_evaluations.sql"),
    file!(10, "results", "0010_results.sql"),
    file!(11, "seal keys", "0011_seal_keys.sql"),
    file!(12, "disputes", "0012_disputes.sql"),
    file!(13, "given up", "0013_given_up.sql"),
    file!(14, "tokens", "0014_tokens.sql"),
    file!(15, "removal", "0015_removal.sql"),
    file!(16, "webhooks", "0016_webhooks.sql"),
    file!(17, "effects", "0017_effects.sql"),
    file!(18, "verification", "0018_verification.sql"),
    file!(19, "repeats", "0019_repeats.sql"),
    file!(20, "members", "0020_members.sql"),
    file!(21, "observables", "0021_observables.sql"),
    file!(22, "emulators", "0022_emulators.sql"),
    file!(23, "no metamodel", "0023_no_metamodel.sql"),
    file!(24, "study details", "0024_study_details.sql"),
    file!(25, "checksums", "0025_checksums.sql"),
    file!(26, "library", "0026_library.sql"),
];

/// The files of `migrations/postgres/`. A server starts with the tables of version 19; later migrations have a file in each folder.
const SERVER_FILES: &[(i64, &str, &str)] = &[
    file!(19, "store", "postgres/0019_store.sql"),
    file!(20, "members", "postgres/0020_members.sql"),
    file!(21, "observables", "postgres/0021_observables.sql"),
    file!(22, "emulators", "postgres/0022_emulators.sql"),
    file!(23, "no metamodel", "postgres/0023_no_metamodel.sql"),
    file!(24, "study details", "postgres/0024_study_details.sql"),
    file!(25, "checksums", "postgres/0025_checksums.sql"),
    file!(26, "library", "postgres/0026_library.sql"),
];

/// The version of the tables that this program writes.
pub(super) const VERSION: i64 = FILES[FILES.len() - 1].0;

/// Returns the migrations of a file.
pub(super) fn migrator() -> Migrator {
    from_files(FILES)
}

/// Returns the migrations of a server.
pub(super) fn server_migrator() -> Migrator {
    from_files(SERVER_FILES)
}

fn from_files(files: &[(i64, &'static str, &'static str)]) -> Migrator {
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
        is_listed("../../migrations", FILES);
        is_listed("../../migrations/postgres", SERVER_FILES);
        let last = SERVER_FILES[SERVER_FILES.len() - 1].0;
        assert_eq!(last, VERSION, "both databases have the same tables");
    }
}
