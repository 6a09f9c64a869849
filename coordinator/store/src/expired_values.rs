//! The predicted values of a calibration that is over, which were kept for a replay alone: they are dropped, and the rows stay.

use record::PREDICTIONS_FROM;
use record::fact::Fact;
use sqlx::AssertSqlSafe;

use super::checksum::EVALUATIONS;
use super::server;
use super::sql::{Conflict, Connection, Kind, Query, Value, insert, query, query_as};

/// The number of rows whose values one commit drops. Results of workers wait no longer than for one such commit.
const PART: i64 = 1000;
/// The size of the values after which a part ends `[B]`.
const PART_BYTES: i64 = 16 << 20;

/// The values of a calibration that are still to be dropped. If the program is killed before, they stay.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct ExpiredValues {
    calibration: i64,
    /// The first evaluation whose values are still to be dropped.
    from: i64,
}

impl ExpiredValues {
    pub(super) fn from_fact(fact: &Fact) -> Option<Self> {
        match *fact {
            Fact::ValuesExpired { calibration, from } => Some(Self {
                calibration,
                from: from as i64,
            }),
            _ => None,
        }
    }

    /// Drops the values of the next rows in a transaction. Returns whether none is left, or the rest stays.
    ///
    /// The values only take room, so a store that cannot drop them goes on with a warning.
    ///
    /// # Errors
    /// The connection is lost.
    pub(super) async fn drop_part(&mut self, connection: &mut Connection) -> Result<bool, sqlx::Error> {
        if let Err(error) = connection.begin().await {
            tracing::warn!(%error, calibration = self.calibration, "values that nobody needs stay in the store");
            return Ok(true);
        }
        match server::in_time(server::GROUP_TIME, self.shorten_rows(connection)).await {
            Ok(is_done) => connection.commit().await.map(|()| is_done),
            Err(error) => {
                tracing::warn!(%error, calibration = self.calibration, "values that nobody needs stay in the store");
                connection.rollback().await.map(|()| true)
            }
        }
    }

    /// Returns the last evaluation of the next part; `None` where none is left.
    async fn end_of_part(&self, connection: &mut Connection) -> Result<Option<i64>, sqlx::Error> {
        let rows: Vec<(i64, i64)> = query_as(
            "SELECT evaluation, CAST(coalesce(length(fitted), 0) + coalesce(length(observables), 0) AS BIGINT) FROM evaluations
             WHERE calibration = ? AND evaluation >= ? AND evaluation < ? AND checksum IS NOT NULL
             AND (length(fitted) > 0 OR observables IS NOT NULL) ORDER BY evaluation LIMIT ?",
        )
        .bind(self.calibration)
        .bind(self.from)
        .bind(PREDICTIONS_FROM as i64)
        .bind(PART)
        .fetch_all(connection)
        .await?;
        let mut bytes = 0;
        let ends = rows.iter().take_while(|(_, length)| {
            let fits = bytes < PART_BYTES;
            bytes += length;
            fits
        });
        Ok(ends.last().map(|(evaluation, _)| *evaluation))
    }

    /// Drops the values of the next rows. Returns whether none is left.
    ///
    /// A damaged row keeps its values, because a new checksum would hide the damage. So does a row of before migration 25, which has none.
    async fn shorten_rows(&mut self, connection: &mut Connection) -> Result<bool, sqlx::Error> {
        let Some(last) = self.end_of_part(connection).await? else {
            return Ok(true);
        };
        let rows = query(
            "SELECT * FROM evaluations WHERE calibration = ? AND evaluation >= ? AND evaluation <= ? AND checksum IS NOT NULL
             AND (length(fitted) > 0 OR observables IS NOT NULL) ORDER BY evaluation",
        )
        .bind(self.calibration)
        .bind(self.from)
        .bind(last)
        .fetch_all(&mut *connection)
        .await?;
        self.from = last + 1;
        let mut short = Vec::with_capacity(rows.len());
        let mut numbers: Vec<Value> = vec![self.calibration.into()];
        for row in rows.iter().filter(|row| EVALUATIONS.verify(row).is_ok()) {
            let value = |(name, kind): &(&str, _)| match *name {
                "fitted" => Ok(Some(Vec::new()).into()),
                "observables" => Ok(None::<Vec<u8>>.into()),
                name => row.value(name, *kind),
            };
            let values: Result<Vec<Value>, sqlx::Error> = EVALUATIONS.columns().map(value).collect();
            let mut sealed = EVALUATIONS.sealed(values?);
            sealed.push(row.value("confirmed_by", Kind::Text)?);
            short.push(sealed);
            numbers.push(row.value("evaluation", Kind::Integer)?);
        }
        if !short.is_empty() {
            // SQLite joins pages that deleted rows leave nearly empty, but not pages whose rows become short.
            let places = vec!["?"; short.len()].join(", ");
            let delete =
                format!("DELETE FROM evaluations WHERE calibration = ? AND evaluation IN ({places})");
            let delete = query(AssertSqlSafe(delete));
            numbers
                .into_iter()
                .fold(delete, Query::bind)
                .execute(&mut *connection)
                .await?;
            let names = [EVALUATIONS.names(), vec!["confirmed_by"]].concat();
            insert("evaluations", &names, short, &Conflict::Keep)
                .execute(&mut *connection)
                .await?;
        }
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use record::{EvaluationRow, Kept};
    use shared::outcome::Observables;
    use sqlx::{Connection as _, SqliteConnection};

    use super::*;
    use crate::{Store, fixture};

    #[tokio::test]
    async fn values_of_a_calibration_that_is_over_are_dropped_and_its_rows_verify() {
        let (folder, store, calibration) = fixture::store().await;
        let count = 2 * PART as u64 + 7;
        let kept = |number: u64| match number % 3 {
            0 => Kept::Fitted(vec![number as f64; 250]),
            1 => Kept::Whole(Box::new(Observables {
                sinkage_m: vec![number as f64; 250],
                ..Observables::default()
            })),
            _ => Kept::Rejected("no_support: condition 0: toy".into()),
        };
        let row = |number: u64| EvaluationRow {
            kept: kept(number),
            ..fixture::row(number, "worker", 7)
        };
        let numbers = (0..count).chain([PREDICTIONS_FROM]);
        let mut facts: Vec<Fact> = numbers
            .map(|number| Fact::Evaluated {
                calibration,
                row: row(number),
            })
            .collect();
        facts.push(Fact::Confirmed {
            calibration,
            evaluation: 3,
            worker: "second".into(),
        });
        facts.push(Fact::ValuesExpired { calibration, from: 3 });
        let last = (store.writer().sink())(facts).unwrap();
        store.writer().durable(last).await.unwrap();
        // The parts follow the commit of the fact. Closing waits for them.
        store.close().await;
        let file = folder.path().join("grouser.db").display().to_string();
        let store = Store::open(&file, 0).await.unwrap();
        let reader = store.reader();
        let stored = reader.stored(calibration, true).await.unwrap();
        for (&number, evaluation) in &stored.evaluations {
            let is_dropped = (3..PREDICTIONS_FROM).contains(&number) && number % 3 != 2;
            let expected = if is_dropped {
                Kept::Scored
            } else {
                row(number).kept
            };
            // The whole result of a final draw is no part of a replay.
            let expected = if number == PREDICTIONS_FROM {
                Kept::Scored
            } else {
                expected
            };
            assert_eq!(
                *evaluation,
                EvaluationRow {
                    kept: expected,
                    ..row(number)
                },
                "{number}"
            );
        }
        assert_eq!(stored.evaluations.len() as u64, count + 1);
        assert_eq!(stored.confirmed[&3], "second");
        let checks = reader.check_rows().await.unwrap();
        assert_eq!((checks[0].checked, checks[0].damaged), (count + 1, 0));
        // Two thirds of the rows had 2,000 bytes. Their pages are free for what is stored next.
        store.close().await;
        let mut connection = SqliteConnection::connect(&file).await.unwrap();
        let free: (i64, i64) = sqlx::query_as(
            "SELECT freelist_count, page_count FROM pragma_freelist_count(), pragma_page_count()",
        )
        .fetch_one(&mut connection)
        .await
        .unwrap();
        assert!(free.0 * 3 > free.1 * 2, "{} of {} pages are free", free.0, free.1);
    }
}
