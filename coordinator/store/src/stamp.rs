//! The stamp of a study's results: a text that names everything that the results depend on.

use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};

use record::CalibrationRow;
use shared::api::CalibrationState;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, On, query_as};

/// Everything that the results of a study depend on: the build of the program, the members, the doubts about workers.
///
/// The facts of a calibration that is over do not change, so its number stands for them; but a worker may be found to compute wrongly
/// later.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stamp {
    build: String,
    members: String,
    doubts: Doubts,
}

/// A digest of the disputes between workers and of the quarantined workers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Doubts(u64);

impl Doubts {
    /// The digest for a store of before migration 18, in which workers are not compared.
    pub const NONE: Doubts = Doubts(0);
}

impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; doubts {:016x}", self.members, self.doubts.0)
    }
}

impl Stamp {
    /// Makes the stamp of a study.
    ///
    /// # Arguments
    /// - `build`: the build of the program that computes the results.
    /// - `members`: number and state of every calibration of the study, oldest first.
    /// - `doubts`: the doubts about workers.
    pub fn new(build: &str, members: impl Iterator<Item = (i64, CalibrationState)>, doubts: Doubts) -> Stamp {
        Stamp {
            build: build.to_owned(),
            members: members_stamp(build, members),
            doubts,
        }
    }

    /// Returns the build of the program that computes the results.
    pub fn build(&self) -> &str {
        &self.build
    }

    /// Returns whether a study is still in the state that this stamp names.
    pub(super) async fn is_current(
        &self,
        connection: &mut Connection,
        study: i64,
    ) -> Result<bool, sqlx::Error> {
        let doubts = doubts(&mut *connection).await?;
        let rows = query_as(
            "SELECT id, state FROM calibrations WHERE study = ? AND withdrawn_at_ms IS NULL ORDER BY id",
        );
        let rows: Vec<(i64, String)> = rows.bind(study).fetch_all(connection).await?;
        let members = rows
            .iter()
            .filter_map(|(id, state)| Some((*id, CalibrationState::from_name(state)?)));
        Ok(*self == Stamp::new(&self.build, members, doubts))
    }
}

/// Returns the part of a stamp that build and members determine: the members that are over, and the number of all.
pub fn members_stamp(build: &str, members: impl Iterator<Item = (i64, CalibrationState)>) -> String {
    let (mut stamp, mut count) = (format!("build {build}"), 0);
    for (id, state) in members {
        count += 1;
        if state.is_final() {
            stamp += &format!(", {id} {}", state.name());
        }
    }
    format!("{stamp} of {count}")
}

/// Returns whether the text of a stamp names this build and these members; its disputes and quarantined workers may differ.
pub fn is_of_members(stamp: &str, members: &str) -> bool {
    stamp.split(';').next() == Some(members)
}

async fn doubts<'a>(on: impl Into<On<'a>>) -> Result<Doubts, sqlx::Error> {
    let rows = query_as(
        "SELECT calibration, evaluation, first, second FROM disputes
         UNION ALL SELECT calibration, evaluation, worker, '' FROM quarantine ORDER BY 1, 2, 3, 4",
    );
    let rows: Vec<(i64, i64, String, String)> = rows.fetch_all(on).await?;
    // Another release of Rust may hash differently. Then results are only computed once more.
    let mut hasher = DefaultHasher::new();
    rows.hash(&mut hasher);
    Ok(Doubts(hasher.finish()))
}

impl Reader {
    /// Reads the doubts about workers; a store of before migration 18 has none.
    async fn doubts(&self) -> Result<Doubts, StoreError> {
        match self.has_table("quarantine").await? {
            true => Ok(doubts(&self.pool).await?),
            false => Ok(Doubts::NONE),
        }
    }

    /// Reads the calibrations of a study, oldest first and without those that were taken out of it, with the stamp of the results that a
    /// build of the program computes from them.
    ///
    /// Doubts are read first: one that arises while the calibrations are read makes the stamp out of date.
    pub async fn stamped_study(
        &self,
        study: i64,
        build: &str,
    ) -> Result<(Stamp, Vec<CalibrationRow>), StoreError> {
        let doubts = self.doubts().await?;
        let (rows, _) = self.members_and_withdrawn(study).await?;
        let stamp = Stamp::new(build, rows.iter().map(|row| (row.id, row.state)), doubts);
        Ok((stamp, rows))
    }
}

#[cfg(test)]
mod tests {
    use record::Fact;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_stamp_changes_with_the_members_that_are_over_and_with_the_doubts() {
        use CalibrationState::{Failed, Finished, Paused, Running};
        let stamp = |states: &[CalibrationState]| members_stamp("b1", (1..).zip(states.iter().copied()));
        let one = stamp(&[Finished]);
        assert_eq!(one, "build b1, 1 finished of 1");
        assert!(stamp(&[Finished, Finished]) != stamp(&[Finished, Failed]));
        assert!(members_stamp("b1", [(2, Finished)].into_iter()) != one);
        assert!(stamp(&[Finished, Running]) != one, "it has grown");
        assert_eq!(stamp(&[Finished, Running]), stamp(&[Finished, Paused]));
        let with_doubts = |doubts| Stamp::new("b1", [(1, Finished)].into_iter(), Doubts(doubts)).to_string();
        assert!(
            with_doubts(1) != with_doubts(0),
            "a worker was found to compute wrongly"
        );
        assert!(is_of_members(&with_doubts(3), &one));
        assert!(!is_of_members(&with_doubts(0), &stamp(&[Failed])));
    }

    #[tokio::test]
    async fn the_doubts_differ_when_one_is_cleared_and_another_one_is_raised() {
        let (_folder, store, calibration) = fixture::store().await;
        let mut sink = store.writer().sink();
        let mut doubts_after = async |facts: Vec<Fact>| {
            let number = sink(facts).unwrap();
            store.writer().durable(number).await.unwrap();
            store.reader().doubts().await.unwrap()
        };
        let quarantined = |worker: &str| Fact::Quarantined {
            worker: worker.into(),
            calibration,
            evaluation: 3,
        };
        let none = store.reader().doubts().await.unwrap();
        let disputed = doubts_after(fixture::dispute(calibration, "a", "b")).await;
        assert!(disputed != none);
        let rewound = Fact::Rewound {
            calibration,
            worker: "a".into(),
            width: 5,
        };
        assert_eq!(doubts_after(vec![rewound]).await, none);
        let disputed_again = doubts_after(fixture::dispute(calibration, "c", "d")).await;
        assert!(disputed_again != none && disputed_again != disputed, "one of one");
        assert!(doubts_after(vec![quarantined("x")]).await != disputed_again);
        store.close().await;
    }
}
