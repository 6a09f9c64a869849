//! The stored results of studies: texts that were computed from a state of the study.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, query, query_as, query_scalar};
use super::stamp::Stamp;

/// Files of a study, computed by one build of the program from one state of the study.
#[derive(Debug, Clone)]
pub struct StudyResults {
    /// Id of the study.
    pub study: i64,
    /// The build and the state of the study from which they were computed.
    pub stamp: Stamp,
    /// Text of each file by its name.
    pub files: BTreeMap<String, String>,
}

/// Writes files of a study and deletes those under other stamps. Files that were computed from an earlier state of the study than the
/// present one are dropped, because a slow request must not replace newer files. A study that is being deleted keeps nothing.
pub(super) async fn write(connection: &mut Connection, results: StudyResults) -> Result<(), sqlx::Error> {
    if !results.stamp.is_current(connection, results.study).await? {
        return Ok(());
    }
    let stamp = results.stamp.to_string();
    query("DELETE FROM results WHERE study = ? AND stamp <> ?")
        .bind(results.study)
        .bind(&stamp)
        .execute(&mut *connection)
        .await?;
    for (name, body) in results.files {
        query(
            "INSERT INTO results (study, name, stamp, body) SELECT id, ?2, ?3, ?4 FROM studies
             WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM deletions WHERE study = ?1)
             ON CONFLICT (study, name) DO UPDATE SET stamp = excluded.stamp, body = excluded.body",
        )
        .bind(results.study)
        .bind(name)
        .bind(&stamp)
        .bind(body)
        .execute(&mut *connection)
        .await?;
    }
    Ok(())
}

impl Reader {
    /// Reads a file of a study, if it was stored under this stamp. A store of before migration 10 has no files.
    pub async fn result(&self, study: i64, name: &str, stamp: &str) -> Result<Option<String>, StoreError> {
        if !self.has_table("results").await? {
            return Ok(None);
        }
        let body = query_scalar("SELECT body FROM results WHERE study = ? AND name = ? AND stamp = ?")
            .bind(study)
            .bind(name)
            .bind(stamp)
            .fetch_optional(&self.pool)
            .await?;
        Ok(body)
    }

    /// Reads the file with one name of every study in a range that has it, with its stamp.
    pub async fn results(
        &self,
        name: &str,
        studies: &RangeInclusive<i64>,
    ) -> Result<BTreeMap<i64, (String, String)>, StoreError> {
        if !self.has_table("results").await? {
            return Ok(BTreeMap::new());
        }
        let rows =
            query_as("SELECT study, stamp, body FROM results WHERE name = ? AND study >= ? AND study <= ?");
        let rows = rows.bind(name).bind(*studies.start()).bind(*studies.end());
        let rows: Vec<(i64, String, String)> = rows.fetch_all(&self.pool).await?;
        let by_study = rows
            .into_iter()
            .map(|(study, stamp, body)| (study, (stamp, body)));
        Ok(by_study.collect())
    }
}

#[cfg(test)]
mod tests {
    use record::Fact;
    use shared::api::CalibrationState;

    use super::*;
    use crate::fixture;

    #[tokio::test]
    async fn results_are_read_under_their_own_stamp_alone_and_an_older_one_replaces_no_newer() {
        let (_folder, store, calibration) = fixture::store().await;
        let reader = store.reader();
        let study = reader.calibration(calibration).await.unwrap().unwrap().study;
        let stamp = async || reader.stamped_study(study, "b1").await.unwrap().0;
        let keep = async |stamp: &Stamp, names: &[&str]| {
            let file = |name: &&str| ((*name).to_owned(), format!("{name} by {stamp}"));
            let files = names.iter().map(file).collect();
            let stamp = stamp.clone();
            let results = StudyResults { study, stamp, files };
            store.writer().keep_results(results).await.unwrap();
        };
        let read = async |name: &str, stamp: &Stamp| {
            let text = reader.result(study, name, &stamp.to_string()).await.unwrap();
            assert!(
                text.as_ref()
                    .is_none_or(|text| *text == format!("{name} by {stamp}"))
            );
            text.is_some()
        };
        let old = stamp().await;
        assert!(!read("report.html", &old).await);
        keep(&old, &["report.html", "diagnostics-1.json"]).await;
        assert!(read("report.html", &old).await);
        let finished = Fact::State {
            calibration,
            state: CalibrationState::Finished,
            message: None,
            busy_ms: 0,
        };
        let number = store.writer().sink()(vec![finished]).unwrap();
        store.writer().durable(number).await.unwrap();
        let new = stamp().await;
        assert!(!read("report.html", &new).await);
        keep(&new, &["report.html"]).await;
        assert!(!read("report.html", &old).await && !read("diagnostics-1.json", &old).await);
        assert!(read("report.html", &new).await);
        keep(&new, &["figures-1.json"]).await;
        keep(&old, &["report.html"]).await;
        assert!(read("report.html", &new).await && read("figures-1.json", &new).await);
        assert!(!read("report.html", &old).await);
        let reports = reader
            .results("report.html", &(i64::MIN..=i64::MAX))
            .await
            .unwrap();
        assert_eq!(reports[&study].0, new.to_string());
        store.close().await;
    }
}
