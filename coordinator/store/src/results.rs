//! The files that a finished study ends with.

use std::collections::BTreeMap;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, query, query_as, query_scalar};

/// Files of a study, computed by one build of the program from one state of the study.
#[derive(Debug, Clone)]
pub struct StudyResults {
    /// The study.
    pub study: i64,
    /// What they were computed by and from.
    pub stamp: String,
    /// Text of each file by its name.
    pub files: BTreeMap<String, String>,
}

/// Writes files of a study; those under another stamp are out of date and go. A study that is deleted meanwhile keeps nothing.
pub(super) async fn write(connection: &mut Connection, results: StudyResults) -> Result<(), sqlx::Error> {
    query("DELETE FROM results WHERE study = ? AND stamp <> ?")
        .bind(results.study)
        .bind(&results.stamp)
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
        .bind(&results.stamp)
        .bind(body)
        .execute(&mut *connection)
        .await?;
    }
    Ok(())
}

impl Reader {
    /// A file of a study, if it was stored under this stamp. Of a store before migration 10, which has none, `None`.
    ///
    /// # Errors
    /// [`StoreError`].
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

    /// The file of one name of every study that has it, with its stamp.
    ///
    /// # Errors
    /// [`StoreError`].
    pub async fn results(&self, name: &str) -> Result<BTreeMap<i64, (String, String)>, StoreError> {
        if !self.has_table("results").await? {
            return Ok(BTreeMap::new());
        }
        let rows = query_as("SELECT study, stamp, body FROM results WHERE name = ?").bind(name);
        let rows: Vec<(i64, String, String)> = rows.fetch_all(&self.pool).await?;
        let by_study = rows
            .into_iter()
            .map(|(study, stamp, body)| (study, (stamp, body)));
        Ok(by_study.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[tokio::test]
    async fn results_are_read_under_their_own_stamp_alone_and_go_with_it() {
        let (_folder, store, calibration) = fixture::store().await;
        let study = store
            .reader()
            .calibration(calibration)
            .await
            .unwrap()
            .unwrap()
            .study;
        let keep = async |stamp: &str, names: &[&str]| {
            let file = |name: &&str| ((*name).to_owned(), format!("{name} by {stamp}"));
            let files = names.iter().map(file).collect();
            let stamp = stamp.to_owned();
            store
                .writer()
                .keep_results(StudyResults { study, stamp, files })
                .await
                .unwrap();
        };
        let read = async |name: &str, stamp: &str| store.reader().result(study, name, stamp).await.unwrap();
        assert_eq!(read("report.html", "one").await, None);
        keep("one", &["report.html", "diagnostics-1.json"]).await;
        assert_eq!(read("report.html", "one").await.unwrap(), "report.html by one");
        assert_eq!(read("report.html", "two").await, None);
        keep("two", &["report.html"]).await;
        assert_eq!(read("report.html", "one").await, None);
        assert_eq!(read("diagnostics-1.json", "one").await, None);
        assert_eq!(read("report.html", "two").await.unwrap(), "report.html by two");
        keep("two", &["figures-1.json"]).await;
        assert!(read("report.html", "two").await.is_some(), "of the same stamp");
        let reports = store.reader().results("report.html").await.unwrap();
        assert_eq!(
            reports[&study],
            ("two".to_owned(), "report.html by two".to_owned())
        );
        store.close().await;
    }
}
