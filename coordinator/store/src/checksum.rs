//! Checksums of rows: a flipped bit in a parameter vector, a likelihood or an observable is an error, and no wrong number.

use futures::TryStreamExt;
use sqlx::AssertSqlSafe;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Kind, NUL, Row, Value, query, query_scalar};

/// The largest number of damaged rows that are named.
const NAMED: usize = 20;

/// A table whose rows carry a checksum.
#[derive(Debug)]
pub(super) struct CheckedTable {
    name: &'static str,
    /// The number of columns of the primary key, which are the first columns.
    key: usize,
    /// The columns that the checksum covers.
    columns: &'static [(&'static str, Kind)],
}

pub(super) const EVALUATIONS: CheckedTable = CheckedTable {
    name: "evaluations",
    key: 2,
    columns: &[
        ("calibration", Kind::Integer),
        ("evaluation", Kind::Integer),
        ("theta", Kind::Bytes),
        ("log_likelihood", Kind::Real),
        ("rejection", Kind::Text),
        ("fitted", Kind::Bytes),
        ("observables", Kind::Bytes),
        ("fingerprint", Kind::Integer),
        ("worker", Kind::Text),
    ],
};

pub(super) const SAMPLES: CheckedTable = CheckedTable {
    name: "samples",
    key: 3,
    columns: &[
        ("calibration", Kind::Integer),
        ("stage", Kind::Integer),
        ("particle", Kind::Integer),
        ("theta", Kind::Bytes),
        ("log_likelihood", Kind::Real),
        ("log_prior", Kind::Real),
    ],
};

pub(super) const STAGES: CheckedTable = CheckedTable {
    name: "stages",
    key: 2,
    columns: &[
        ("calibration", Kind::Integer),
        ("stage", Kind::Integer),
        ("tempering_exponent", Kind::Real),
        ("acceptance", Kind::Real),
        ("drift_z", Kind::Real),
        ("correlation", Kind::Real),
        ("steps", Kind::Integer),
        ("log_evidence_increment", Kind::Real),
        ("weight_cov", Kind::Real),
        ("ess", Kind::Real),
        ("scale", Kind::Real),
        ("evaluations", Kind::Integer),
        ("equilibrated", Kind::Truth),
    ],
};

/// The rows of a table, as a check has found them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableCheck {
    /// Name of the table.
    pub table: &'static str,
    /// Number of rows with a checksum.
    pub checked: u64,
    /// Number of rows without one, which versions before migration 25 wrote.
    pub unchecked: u64,
    /// Number of damaged rows.
    pub damaged: u64,
    /// The first damaged rows, by their keys.
    pub named: Vec<String>,
}

impl CheckedTable {
    /// Returns the names of the columns of a row with its checksum.
    pub(super) fn names(&self) -> Vec<&'static str> {
        let names = self.columns.iter().map(|(name, _)| *name);
        names.chain(["checksum"]).collect()
    }

    /// Returns the columns that the checksum covers.
    pub(super) fn columns(&self) -> impl Iterator<Item = &'static (&'static str, Kind)> {
        self.columns.iter()
    }

    /// Adds the checksum to the values of a row, in the order of the columns.
    pub(super) fn sealed(&self, mut row: Vec<Value>) -> Vec<Value> {
        debug_assert_eq!(row.len(), self.columns.len());
        let checksum = checksum(&row);
        row.push(checksum.into());
        row
    }

    /// Verifies the checksum of a row with all columns. Returns whether it has one.
    ///
    /// # Errors
    /// [`StoreError::Corrupt`] with the key of a damaged row.
    pub(super) fn verify(&self, row: &Row) -> Result<bool, StoreError> {
        let stored: Option<i64> = match row.try_get("checksum") {
            // The tables of before migration 25, opened for reading alone.
            Err(sqlx::Error::ColumnNotFound(_)) => None,
            stored => stored?,
        };
        let Some(stored) = stored else { return Ok(false) };
        let values: Result<Vec<Value>, _> = self
            .columns
            .iter()
            .map(|(name, kind)| row.value(name, *kind))
            .collect();
        match values {
            Ok(values) if checksum(&values) == stored => Ok(true),
            // A column of another type is damage as well.
            Ok(_) | Err(sqlx::Error::ColumnDecode { .. }) => Err(StoreError::Corrupt(format!(
                "{} of table {}: the row is damaged, because its checksum does not match; put a backup back, or compute it again",
                self.key_of(row),
                self.name
            ))),
            Err(error) => Err(error.into()),
        }
    }

    fn key_of(&self, row: &Row) -> String {
        let value = |(name, _): &(&str, Kind)| {
            let value: Result<i64, _> = row.try_get(name);
            value.map_or_else(
                |_| format!("{name} unreadable"),
                |value| format!("{name} {value}"),
            )
        };
        let key: Vec<String> = self.columns[..self.key].iter().map(value).collect();
        key.join(", ")
    }
}

/// Returns the CRC-32 of values. A file does not keep the sign of zero, and a server no NUL, so neither counts.
fn checksum(values: &[Value]) -> i64 {
    let mut crc = crc32fast::Hasher::new();
    let mut add = |kind: u8, bytes: Option<&[u8]>| {
        crc.update(&[kind, u8::from(bytes.is_some())]);
        if let Some(bytes) = bytes {
            crc.update(&(bytes.len() as u64).to_le_bytes());
            crc.update(bytes);
        }
    };
    for value in values {
        match value {
            Value::Integer(value) => add(0, value.map(i64::to_le_bytes).as_ref().map(|b| &b[..])),
            Value::Real(value) => {
                let value = value
                    .filter(|x| !x.is_nan())
                    .map(|x| if x == 0.0 { 0.0 } else { x });
                add(1, value.map(f64::to_le_bytes).as_ref().map(|b| &b[..]));
            }
            Value::Truth(value) => add(2, value.map(|truth| [u8::from(truth)]).as_ref().map(|b| &b[..])),
            Value::Text(value) => {
                let value = value.as_ref().map(|text| text.replace('\0', NUL));
                add(3, value.as_deref().map(str::as_bytes));
            }
            Value::Bytes(value) => add(4, value.as_deref()),
        }
    }
    i64::from(crc.finalize())
}

impl Reader {
    /// Reads every row that carries a checksum, and verifies it.
    ///
    /// # Errors
    /// The store cannot be read.
    pub async fn check_rows(&self) -> Result<Vec<TableCheck>, StoreError> {
        let mut checks = Vec::new();
        for table in [&EVALUATIONS, &SAMPLES, &STAGES] {
            let mut check = TableCheck {
                table: table.name,
                checked: 0,
                unchecked: 0,
                damaged: 0,
                named: Vec::new(),
            };
            let calibrations: Vec<i64> = query_scalar("SELECT id FROM calibrations ORDER BY id")
                .fetch_all(&self.pool)
                .await?;
            for calibration in calibrations {
                let mut view = self.pool.view().await?;
                let select = format!("SELECT * FROM {} WHERE calibration = ?", table.name);
                let mut rows = query(AssertSqlSafe(select)).bind(calibration).fetch(&mut view);
                while let Some(row) = rows.try_next().await? {
                    match table.verify(&row) {
                        Ok(true) => check.checked += 1,
                        Ok(false) => check.unchecked += 1,
                        Err(StoreError::Corrupt(_)) => {
                            check.damaged += 1;
                            if check.named.len() < NAMED {
                                check.named.push(table.key_of(&row));
                            }
                        }
                        Err(error) => return Err(error),
                    }
                }
                drop(rows);
                view.close().await?;
            }
            checks.push(check);
        }
        Ok(checks)
    }
}

#[cfg(test)]
mod tests {
    use inference::Particle;
    use record::{Fact, Kept, PREDICTIONS_FROM};
    use shared::outcome::Observables;
    use statistics::LogLikelihood;

    use super::*;
    use crate::fixture;

    #[test]
    fn what_a_database_does_not_keep_does_not_count() {
        let sum = |value: Value| checksum(&[value]);
        assert_eq!(sum(0.0.into()), sum((-0.0).into()));
        assert_ne!(sum(1.0.into()), sum((1.0 + f64::EPSILON).into()));
        assert_eq!(sum("a\0".into()), sum(format!("a{NUL}").into()));
        assert_ne!(sum(Value::Text(None)), sum("".into()));
        assert_ne!(
            checksum(&["a".into(), "b".into()]),
            checksum(&["ab".into(), "".into()])
        );
    }

    #[tokio::test]
    async fn a_flipped_bit_of_a_row_is_an_error_and_is_found_by_a_check_of_all_rows() {
        let (_folder, store, calibration) = fixture::store().await;
        let whole = Kept::Whole(Box::new(Observables {
            sinkage_m: vec![0.25],
            ..Observables::default()
        }));
        let draw = record::EvaluationRow {
            kept: whole,
            ..fixture::row(PREDICTIONS_FROM, "w", 7)
        };
        let population = vec![Particle {
            theta: vec![-0.0, 1.5],
            log_likelihood: LogLikelihood::new(-3.5).unwrap(),
            log_prior: -0.0,
        }];
        let facts = vec![
            Fact::Evaluated {
                calibration,
                row: fixture::row(3, "a", 7),
            },
            Fact::Evaluated {
                calibration,
                row: draw,
            },
            Fact::Stage {
                calibration,
                record: Box::new(inference::StageRecord {
                    population,
                    ..fixture::stage()
                }),
                busy_ms: 0,
            },
        ];
        let fact = (store.writer().sink())(facts).unwrap();
        store.writer().durable(fact).await.unwrap();
        let reader = store.reader();
        let damaged = async || {
            let checks = reader.check_rows().await.unwrap();
            checks
                .iter()
                .map(|check| (check.checked, check.unchecked, check.damaged))
                .collect::<Vec<_>>()
        };
        assert_eq!(damaged().await, [(2, 0, 0), (1, 0, 0), (1, 0, 0)]);
        let flips = [
            (
                "UPDATE samples SET theta = x'0000000000000080000000000000f43f'",
                1,
            ),
            ("UPDATE stages SET ess = 7.0", 2),
            (
                "UPDATE evaluations SET log_likelihood = -1.0 WHERE evaluation = 3",
                0,
            ),
        ];
        for (k, (flip, table)) in flips.into_iter().enumerate() {
            query(flip).execute(&reader.pool).await.unwrap();
            let found = damaged().await;
            assert_eq!(found[table].2, 1, "{flip}: {found:?}");
            assert_eq!(found.iter().map(|found| found.2).sum::<u64>(), k as u64 + 1);
        }
        let message = |error: StoreError| error.to_string();
        let samples = message(reader.samples(calibration, None).await.unwrap_err());
        assert!(
            samples.contains("stage 1, particle 0 of table samples"),
            "{samples}"
        );
        assert!(reader.thinned_samples(calibration, None, 5).await.is_err());
        assert!(reader.stages(calibration).await.is_err());
        let stored = message(reader.stored(calibration, false).await.unwrap_err());
        assert!(stored.contains("evaluation 3"), "{stored}");
        assert_eq!(reader.predictions(calibration).await.unwrap().len(), 1);
        query("UPDATE evaluations SET observables = zeroblob(8) WHERE evaluation > 3")
            .execute(&reader.pool)
            .await
            .unwrap();
        assert!(reader.predictions(calibration).await.is_err());
        // A row of an earlier version has no checksum, and is read as it is.
        query("UPDATE samples SET checksum = NULL")
            .execute(&reader.pool)
            .await
            .unwrap();
        assert_eq!(
            reader.samples(calibration, None).await.unwrap()[0].theta,
            [-0.0, 1.25]
        );
        store.close().await;
    }
}
