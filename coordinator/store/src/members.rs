//! The place of each calibration in its study, for stores that versions before migration 20 wrote.
//!
//! These versions did not store the place. They named a calibration after its parent, and a search had a job that they derived from the job
//! of the searched calibration. Only this file applies these two rules.

use std::collections::BTreeMap;

use shared::file::FileSet;

use super::error::StoreError;
use super::json::{file_map, json};
use super::sql::{Connection, On, Row, query, query_scalar};
use job::{
    AlgorithmSettings, Job, continued_job, earlier_search, effect_name, is_earlier_search, searched_model,
    without_metamodel,
};
use record::{Change, Extension, Membership, Role};

/// The name of a job in messages.
pub(super) const JOB: &str = "job.toml";

/// The row of a calibration as an earlier version stored it.
#[derive(Debug, Clone)]
struct EarlierRow {
    id: i64,
    study: i64,
    experiment: i64,
    name: String,
    job: FileSet,
}

/// The columns of a calibration that an earlier version did not store.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Filled {
    pub(super) membership: Membership,
    /// The job in the present language, where the language of the earlier version is no longer part of it.
    pub(super) toml: Option<String>,
}

/// Fills the new columns of the rows that an earlier version wrote.
///
/// # Errors
/// The error of the database.
pub(super) async fn fill(connection: &mut Connection, path: &str) -> Result<(), StoreError> {
    let wrap = |source| StoreError::new(path, source);
    let empty = query_scalar("SELECT count(*) FROM calibrations WHERE role IS NULL");
    let empty: i64 = empty.fetch_one(&mut *connection).await.map_err(wrap)?;
    if empty == 0 {
        return Ok(());
    }
    connection.begin().await.map_err(wrap)?;
    let filled = filled(&mut *connection).await.map_err(wrap)?;
    for (id, filled) in filled {
        let Membership { role, parent, change } = filled.membership;
        if parent.is_some() && change.is_none() && role != Role::Search {
            tracing::warn!(
                id,
                "the store does not say how this calibration follows from its study"
            );
        }
        query(
            "UPDATE calibrations SET role = ?, parent = ?, change = ?, toml = coalesce(?, toml)
             WHERE id = ? AND role IS NULL",
        )
        .bind(role.name())
        .bind(parent)
        .bind(change.as_ref().map(json))
        .bind(filled.toml)
        .bind(id)
        .execute(&mut *connection)
        .await
        .map_err(wrap)?;
    }
    connection.commit().await.map_err(wrap)
}

/// Computes the columns that the rows of an earlier version lack, by the id of the row.
///
/// # Errors
/// The error of the database.
pub(super) async fn filled(on: impl Into<On<'_>>) -> Result<BTreeMap<i64, Filled>, sqlx::Error> {
    let rows = query(
        "SELECT c.id, c.study, coalesce(c.experiment, s.experiment) AS on_experiment, c.name, c.toml, c.files
         FROM calibrations c JOIN studies s ON s.id = c.study ORDER BY c.study, c.id",
    )
    .fetch_all(on)
    .await?;
    let rows: Vec<EarlierRow> = rows.iter().map(earlier_row).collect::<Result<_, _>>()?;
    let studies = rows.chunk_by(|a, b| a.study == b.study);
    Ok(studies.flat_map(filled_study).collect())
}

fn earlier_row(row: &Row) -> Result<EarlierRow, sqlx::Error> {
    Ok(EarlierRow {
        id: row.try_get("id")?,
        study: row.try_get("study")?,
        experiment: row.try_get("on_experiment")?,
        // An unreadable row is reported where its calibration is requested.
        name: row.try_get("name").unwrap_or_default(),
        job: FileSet {
            toml: row.try_get("toml").unwrap_or_default(),
            files: row
                .try_get("files")
                .map_or_else(|_| BTreeMap::new(), |files| file_map(files).unwrap_or_default()),
        },
    })
}

/// Computes the new columns for the calibrations of a study, oldest first.
fn filled_study(rows: &[EarlierRow]) -> Vec<(i64, Filled)> {
    let (searches, calibrations): (Vec<&EarlierRow>, Vec<&EarlierRow>) =
        rows.iter().partition(|row| is_earlier_search(&row.job.toml));
    // A job that this version does not understand compares no models.
    let lead = calibrations.first();
    let models = lead.and_then(|lead| parsed(lead)).map_or(1, |job| job.models);
    let mut filled: Vec<(i64, Filled)> = Vec::new();
    for (number, row) in calibrations.iter().enumerate() {
        let membership = match calibrations[..number].first() {
            None => Membership::submitted(role(row)),
            Some(lead) if number < models => Membership::changed(role(row), lead.id, Change::Model(number)),
            Some(lead) => follower(row, lead, &calibrations[..number]),
        };
        filled.push((
            row.id,
            Filled {
                membership,
                toml: None,
            },
        ));
    }
    filled.extend(
        searches
            .into_iter()
            .map(|row| (row.id, search(row, &calibrations))),
    );
    filled
}

/// Returns the role of a calibration from its job. A job that this version does not understand counts as a sample.
fn role(row: &EarlierRow) -> Role {
    match parsed(row).map(|job| job.algorithm) {
        Some(AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_)) => Role::Fit,
        Some(AlgorithmSettings::Sample(_) | AlgorithmSettings::Discover { .. }) | None => Role::Sample,
    }
}

/// Parses a job of an earlier version; `None` if this version does not understand it.
fn parsed(row: &EarlierRow) -> Option<Job> {
    let toml = without_metamodel(JOB, &row.job.toml).ok()?;
    Job::parse(JOB, &toml).ok()
}

/// Finds the calibration that a search belongs to: the first one with the same model; if none has the same text, the one that the search is
/// named after; if that one is gone, the search keeps its own job.
fn search(row: &EarlierRow, calibrations: &[&EarlierRow]) -> Filled {
    let is_searched = |other: &&&EarlierRow| {
        other.experiment == row.experiment
            && earlier_search(JOB, &other.job).is_ok_and(|search| search == row.job)
    };
    let is_named = |other: &&&EarlierRow| {
        let name = row.name.strip_suffix(" (discovery)");
        other.experiment == row.experiment && name == Some(&other.name)
    };
    let by_text = calibrations.iter().find(is_searched);
    let searched = by_text.or_else(|| calibrations.iter().rfind(is_named));
    let job = match searched {
        Some(searched) => continued_job(JOB, &searched.job),
        None => searched_model(JOB, &row.job),
    };
    let parent = searched.or(calibrations.first()).map(|other| other.id);
    Filled {
        membership: Membership {
            role: Role::Search,
            parent,
            change: None,
        },
        toml: job.ok().map(|job| job.toml),
    }
}

/// Computes the place of a calibration that joined its study later, or of a point estimate that the job requests.
fn follower(row: &EarlierRow, lead: &EarlierRow, earlier: &[&EarlierRow]) -> Membership {
    let role = role(row);
    // The parent is the calibration with the longest name that this name begins with.
    let named = earlier
        .iter()
        .rev()
        .filter_map(|other| Some((*other, row.name.strip_prefix(&other.name)?)))
        .min_by_key(|(_, rest)| rest.len());
    if let Some((parent, rest)) = named
        && let Some(change) = change(row, parent, rest)
    {
        return Membership::changed(role, parent.id, change);
    }
    Membership {
        role,
        parent: Some(lead.id),
        change: None,
    }
}

/// Returns the change that the remaining part of a calibration's name states.
fn change(row: &EarlierRow, parent: &EarlierRow, rest: &str) -> Option<Change> {
    if let Some(effect) = rest.strip_prefix('+') {
        return Some(Change::Add(addition(row, parent, effect)));
    }
    if let Some(effects) = rest.strip_prefix('-') {
        return Some(Change::Drop(effects.split('-').map(str::to_owned).collect()));
    }
    let word = rest.strip_prefix(" (")?.strip_suffix(')')?;
    if let Some(runs) = word.strip_suffix(" runs") {
        return runs.parse().ok().map(Change::Runs);
    }
    let job = parsed(row)?;
    (job.algorithm.name() == word).then(|| Change::Algorithm(word.to_owned()))
}

fn addition(row: &EarlierRow, parent: &EarlierRow, effect: &str) -> Extension {
    let file = row.job.files.iter().find(|(file, text)| {
        !parent.job.files.contains_key(*file) && effect_name(text).is_some_and(|name| name == effect)
    });
    match (file, effect.split_once('.')) {
        (Some((name, text)), _) => Extension::File {
            name: name.clone(),
            text: text.clone(),
        },
        (None, Some((effect, wheel))) => Extension::OnWheel {
            effect: effect.to_owned(),
            wheel: wheel.to_owned(),
        },
        (None, None) => Extension::Effect(effect.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "[model]\nkind = \"quasi_static\"\n";

    fn row(id: i64, name: &str, toml: &str) -> EarlierRow {
        EarlierRow {
            id,
            study: 1,
            experiment: 1,
            name: name.into(),
            job: FileSet {
                toml: toml.into(),
                files: BTreeMap::new(),
            },
        }
    }

    fn search_row(id: i64, searched: &EarlierRow) -> EarlierRow {
        EarlierRow {
            id,
            job: earlier_search(JOB, &searched.job).unwrap(),
            ..searched.clone()
        }
    }

    /// Returns the memberships by id.
    fn memberships(rows: &[EarlierRow]) -> BTreeMap<i64, Membership> {
        let filled = filled_study(rows);
        filled
            .into_iter()
            .map(|(id, filled)| (id, filled.membership))
            .collect()
    }

    #[test]
    fn names_say_what_was_added_dropped_and_by_which_algorithm() {
        let mut with_file = row(6, "sand+janosi_hanamoto+mine", MODEL);
        with_file
            .job
            .files
            .insert("mine.toml".into(), "name = \"mine\"\n".into());
        let rows = [
            row(1, "sand", MODEL),
            row(2, "sand (lm)", &format!("{MODEL}[sampler]\nalgorithm = \"lm\"\n")),
            row(3, "sand+janosi_hanamoto", MODEL),
            row(4, "sand+janosi_hanamoto+slip_digging.grousered", MODEL),
            row(
                5,
                "sand+janosi_hanamoto+slip_digging.grousered-janosi_hanamoto",
                MODEL,
            ),
            with_file,
            EarlierRow {
                experiment: 2,
                ..row(7, "sand+janosi_hanamoto (29 runs)", MODEL)
            },
        ];
        let given = memberships(&rows);
        let effect = |name: &str| Change::Add(Extension::Effect(name.into()));
        let on_wheel = Change::Add(Extension::OnWheel {
            effect: "slip_digging".into(),
            wheel: "grousered".into(),
        });
        let file = Change::Add(Extension::File {
            name: "mine.toml".into(),
            text: "name = \"mine\"\n".into(),
        });
        let expected = [
            (1, Membership::submitted(Role::Sample)),
            (
                2,
                Membership::changed(Role::Fit, 1, Change::Algorithm("lm".into())),
            ),
            (3, Membership::changed(Role::Sample, 1, effect("janosi_hanamoto"))),
            (4, Membership::changed(Role::Sample, 3, on_wheel)),
            (
                5,
                Membership::changed(Role::Sample, 4, Change::Drop(vec!["janosi_hanamoto".into()])),
            ),
            (6, Membership::changed(Role::Sample, 3, file)),
            (7, Membership::changed(Role::Sample, 3, Change::Runs(29))),
        ];
        assert_eq!(given, expected.into());
    }

    #[test]
    fn the_first_members_are_the_models_that_the_job_compares() {
        let job = "[[models]]\nkind = \"quasi_static\"\n[[models]]\nkind = \"rft\"\n";
        let rows = [row(1, "sand", job), row(2, "sand (rft)", MODEL)];
        let expected = Membership::changed(Role::Sample, 1, Change::Model(1));
        assert_eq!(memberships(&rows)[&2], expected);
    }

    #[test]
    fn a_search_is_of_the_first_calibration_that_has_its_model() {
        let base = row(1, "sand", &format!("{MODEL}[sampler]\nseed = 7\n"));
        let other = row(2, "sand+a", &format!("{MODEL}n = 1.0\n[sampler]\nseed = 7\n"));
        let searches = [search_row(3, &other), search_row(4, &base)];
        let rows = [vec![base, other], searches.to_vec()].concat();
        let given = memberships(&rows);
        assert_eq!(given[&3], Membership::search_of(2));
        assert_eq!(given[&4], Membership::search_of(1));
        // This version reads the job that it stands for.
        let filled: BTreeMap<i64, Filled> = filled_study(&rows).into_iter().collect();
        let toml = filled[&3].toml.clone().unwrap();
        assert_eq!(Job::parse(JOB, &toml).unwrap().algorithm.seed(), 7);
        assert!(toml.contains("n = 1.0"), "{toml}");
    }

    #[test]
    fn a_search_whose_text_an_earlier_release_wrote_otherwise_is_found_by_its_name() {
        let (base, other) = (
            row(1, "sand", MODEL),
            row(2, "sand+a", &format!("{MODEL}n = 1.0\n")),
        );
        let mut search = search_row(3, &other);
        search.job.toml.push_str("\n# another release\n");
        search.name = "sand+a (discovery)".into();
        assert_eq!(memberships(&[base, other, search])[&3], Membership::search_of(2));
    }

    #[test]
    fn what_an_earlier_version_did_not_leave_is_not_guessed() {
        let rows = [row(1, "sand", MODEL), row(2, "rock", "no job")];
        let expected = Membership {
            role: Role::Sample,
            parent: Some(1),
            change: None,
        };
        assert_eq!(memberships(&rows)[&2], expected);
        // The searched calibration has been lost: the search stays with the study, and with its own model.
        let lost = row(9, "lost", &format!("{MODEL}n = 1.0\n"));
        let rows = [row(1, "sand", MODEL), search_row(3, &lost)];
        let filled: BTreeMap<i64, Filled> = filled_study(&rows).into_iter().collect();
        assert_eq!(filled[&3].membership, Membership::search_of(1));
        assert!(filled[&3].toml.as_ref().unwrap().contains("n = 1.0"));
    }
}
