//! What people say of studies, and which calibrations they took out of them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use record::{CalibrationRow, StudyDetails};

use super::error::StoreError;
use super::json::json;
use super::reader::Reader;
use super::sql::{Connection, query, query_as, query_scalar};

/// Keeps what people say of a study.
pub(super) async fn write_details(
    connection: &mut Connection,
    study: i64,
    details: &StudyDetails,
) -> Result<(), sqlx::Error> {
    query("UPDATE studies SET details = ? WHERE id = ?")
        .bind(json(details))
        .bind(study)
        .execute(connection)
        .await
        .map(drop)
}

/// Takes calibrations out of their study at a time; without a time, takes them in again.
pub(super) async fn withdraw(
    connection: &mut Connection,
    calibrations: &[i64],
    at_ms: Option<i64>,
) -> Result<(), sqlx::Error> {
    for &calibration in calibrations {
        query("UPDATE calibrations SET withdrawn_at_ms = ? WHERE id = ?")
            .bind(at_ms)
            .bind(calibration)
            .execute(&mut *connection)
            .await?;
    }
    Ok(())
}

impl Reader {
    /// Reads what people say of studies, by study. A store of before migration 24 has nothing.
    pub async fn study_details(
        &self,
        studies: &RangeInclusive<i64>,
    ) -> Result<BTreeMap<i64, StudyDetails>, StoreError> {
        if !self.has_column("studies", "details").await? {
            return Ok(BTreeMap::new());
        }
        let rows =
            query_as("SELECT id, details FROM studies WHERE details IS NOT NULL AND id >= ? AND id <= ?");
        let rows = rows.bind(*studies.start()).bind(*studies.end());
        let rows: Vec<(i64, String)> = rows.fetch_all(&self.pool).await?;
        let read = |(study, text): (i64, String)| {
            let corrupt = |e| StoreError::Corrupt(format!("details of study {study}: {e}"));
            Ok((study, serde_json::from_str(&text).map_err(corrupt)?))
        };
        rows.into_iter().map(read).collect()
    }

    /// Reads the calibrations of a study, oldest first: those that are part of it, and those that were taken out of it.
    pub async fn members_and_withdrawn(
        &self,
        study: i64,
    ) -> Result<(Vec<CalibrationRow>, Vec<CalibrationRow>), StoreError> {
        let withdrawn = self.withdrawn().await?;
        let rows = self.study(study).await?.into_iter();
        Ok(rows.partition(|row| !withdrawn.contains(&row.id)))
    }

    /// Reads the calibrations that were taken out of their studies. A store of before migration 24 has none.
    pub async fn withdrawn(&self) -> Result<BTreeSet<i64>, StoreError> {
        if !self.has_column("calibrations", "withdrawn_at_ms").await? {
            return Ok(BTreeSet::new());
        }
        let ids = query_scalar("SELECT id FROM calibrations WHERE withdrawn_at_ms IS NOT NULL");
        let ids: Vec<i64> = ids.fetch_all(&self.pool).await?;
        Ok(ids.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[tokio::test]
    async fn details_are_read_back_and_a_withdrawn_calibration_leaves_the_results_of_its_study() {
        let (_folder, store, calibration) = fixture::store().await;
        let (reader, writer) = (store.reader(), store.writer());
        let study = reader.calibration(calibration).await.unwrap().unwrap().study;
        assert!(reader.study_details(&(study..=study)).await.unwrap().is_empty());
        let details = StudyDetails {
            author: Some("Zoë".into()),
            tags: vec!["dry".into()],
            ..StudyDetails::default()
        };
        writer.describe_study(study, details.clone()).await.unwrap();
        let described = reader.study_details(&(study..=study)).await.unwrap();
        assert_eq!(described[&study], details);
        assert!(
            reader
                .study_details(&(study + 1..=i64::MAX))
                .await
                .unwrap()
                .is_empty()
        );
        let stamped = async || reader.stamped_study(study, "b").await.unwrap();
        let whole = stamped().await;
        writer.withdraw(vec![calibration], Some(1)).await.unwrap();
        let (stamp, rows) = stamped().await;
        assert!(rows.is_empty() && stamp != whole.0);
        assert!(reader.member_states().await.unwrap().is_empty());
        let (members, withdrawn) = reader.members_and_withdrawn(study).await.unwrap();
        assert_eq!((members.len(), withdrawn.len()), (0, 1));
        writer.withdraw(vec![calibration], None).await.unwrap();
        assert_eq!(stamped().await.0, whole.0);
        store.close().await;
    }
}
