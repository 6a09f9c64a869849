//! Queries for lists, as a whole or page by page.

use std::ops::RangeInclusive;

use super::error::StoreError;
use super::read::CALIBRATION;
use super::reader::Reader;
use super::sql::{Row, query, query_as, query_scalar};
use record::CalibrationRow;

/// A part of a list that is ordered by ids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IdPage {
    /// The id before the first of the page.
    pub after: i64,
    /// The largest number of entries.
    pub limit: i64,
}

impl IdPage {
    /// The whole list.
    pub const ALL: IdPage = IdPage {
        after: i64::MIN,
        limit: i64::MAX,
    };

    /// Returns what is read next for a page of which a number of entries is listed, where others were left out; `None` once it is full.
    ///
    /// It may have more entries than the page lacks, because a few rows at a time would be a query for each that is left out. Checked by
    /// `tests::the_rest_of_a_page_is_read_by_a_hundred_rows_at_least`.
    pub fn rest(self, after: i64, listed: usize) -> Option<IdPage> {
        let lacking = self.limit.saturating_sub_unsigned(listed as u64);
        (lacking > 0).then(|| IdPage {
            after,
            limit: lacking.max(LEAST_ROWS),
        })
    }
}

/// The least number of rows that are read at once where some are left out.
const LEAST_ROWS: i64 = 100;

/// A calibration by its id, or the reason why its row cannot be read.
pub type ListedCalibration = (i64, Result<CalibrationRow, StoreError>);

impl Reader {
    /// Reads experiments, oldest first, with the studies that have a calibration on them.
    pub async fn experiments(&self, page: IdPage) -> Result<Vec<(i64, Vec<i64>)>, StoreError> {
        let rows = query_as(
            "SELECT e.id, m.study FROM (SELECT id FROM experiments WHERE id > ? ORDER BY id LIMIT ?) e LEFT JOIN
             (SELECT DISTINCT coalesce(c.experiment, s.experiment) AS experiment, c.study
              FROM calibrations c JOIN studies s ON s.id = c.study) m ON m.experiment = e.id ORDER BY e.id, m.study",
        );
        let rows: Vec<(i64, Option<i64>)> = rows
            .bind(page.after)
            .bind(page.limit)
            .fetch_all(&self.pool)
            .await?;
        let mut experiments: Vec<(i64, Vec<i64>)> = Vec::new();
        for (experiment, study) in rows {
            match experiments.last_mut() {
                Some((last, studies)) if *last == experiment => studies.extend(study),
                _ => experiments.push((experiment, study.into_iter().collect())),
            }
        }
        Ok(experiments)
    }

    /// Reads calibrations by their ids, oldest first. A row that cannot be read is replaced by its error.
    ///
    /// # Errors
    /// [`StoreError`] where no row can be read.
    pub async fn calibrations(&self, page: IdPage) -> Result<Vec<ListedCalibration>, StoreError> {
        let sql = format!("{CALIBRATION} WHERE c.id > ? ORDER BY c.id LIMIT ?");
        self.listed(&sql, [page.after, page.limit]).await
    }

    /// Reads the calibrations of the studies with ids in a range, as [`Reader::calibrations`] does.
    pub async fn calibrations_of(
        &self,
        studies: &RangeInclusive<i64>,
    ) -> Result<Vec<ListedCalibration>, StoreError> {
        let sql = format!("{CALIBRATION} WHERE c.study >= ? AND c.study <= ? ORDER BY c.id");
        self.listed(&sql, [*studies.start(), *studies.end()]).await
    }

    async fn listed(&self, sql: &str, bounds: [i64; 2]) -> Result<Vec<ListedCalibration>, StoreError> {
        let [first, second] = bounds;
        let rows = query(sqlx::AssertSqlSafe(sql.to_owned()));
        let rows = rows.bind(first).bind(second).fetch_all(&self.pool).await?;
        let row = |row: &Row| Ok((row.try_get("id")?, self.calibration_row(row)));
        rows.iter().map(row).collect()
    }

    /// Reads the ids of studies, oldest first.
    pub async fn study_ids(&self, page: IdPage) -> Result<Vec<i64>, StoreError> {
        let ids = query_scalar("SELECT id FROM studies WHERE id > ? ORDER BY id LIMIT ?");
        Ok(ids
            .bind(page.after)
            .bind(page.limit)
            .fetch_all(&self.pool)
            .await?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_of_a_page_is_read_by_a_hundred_rows_at_least() {
        let page = IdPage { after: 0, limit: 200 };
        let rest = |listed| page.rest(7, listed).map(|rest| (rest.after, rest.limit));
        assert_eq!(rest(20), Some((7, 180)));
        assert_eq!(rest(199), Some((7, 100)));
        assert_eq!((rest(200), rest(250)), (None, None));
    }
}
