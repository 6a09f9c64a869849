//! Statistics of external models that are evaluated twice at the same parameters.

use shared::exchange::RepeatedAnswer;

use super::error::StoreError;
use super::reader::Reader;
use super::sql::{Connection, query, query_as};
use record::Repeats;

/// Adds two answers to the statistics of a calibration.
pub(super) async fn add(
    connection: &mut Connection,
    calibration: i64,
    repeated: &RepeatedAnswer,
) -> Result<(), sqlx::Error> {
    query(
        "INSERT INTO repeats (calibration, evaluations, differing, refused,
         drawbar_pull_n, torque_n_m, sinkage_m, lateral_force_n) VALUES (?, 1, ?, ?, ?, ?, ?, ?)
         ON CONFLICT (calibration) DO UPDATE SET evaluations = repeats.evaluations + 1,
         differing = repeats.differing + excluded.differing, refused = repeats.refused OR excluded.refused,
         drawbar_pull_n = max(repeats.drawbar_pull_n, excluded.drawbar_pull_n),
         torque_n_m = max(repeats.torque_n_m, excluded.torque_n_m),
         sinkage_m = max(repeats.sinkage_m, excluded.sinkage_m),
         lateral_force_n = max(repeats.lateral_force_n, excluded.lateral_force_n)",
    )
    .bind(calibration)
    .bind(i64::from(repeated.differs()))
    .bind(repeated.is_refused)
    .bind(repeated.drawbar_pull_n)
    .bind(repeated.torque_n_m)
    .bind(repeated.sinkage_m)
    .bind(repeated.lateral_force_n)
    .execute(connection)
    .await
    .map(drop)
}

impl Reader {
    /// Reads how the external model of a calibration answered when it was evaluated twice. A calibration of a built-in model, and a store
    /// of before migration 19, have no such statistics.
    pub async fn repeats(&self, calibration: i64) -> Result<Repeats, StoreError> {
        if !self.has_table("repeats").await? {
            return Ok(Repeats::default());
        }
        let row: Option<(i64, i64, bool, f64, f64, f64, f64)> = query_as(
            "SELECT evaluations, differing, refused, drawbar_pull_n, torque_n_m, sinkage_m, lateral_force_n
             FROM repeats WHERE calibration = ?",
        )
        .bind(calibration)
        .fetch_optional(&self.pool)
        .await?;
        let repeats = row.map(
            |(evaluations, differing, is_refused, pull, torque, sinkage, lateral)| Repeats {
                evaluations: evaluations.unsigned_abs(),
                differing: differing.unsigned_abs(),
                largest: RepeatedAnswer {
                    drawbar_pull_n: pull,
                    torque_n_m: torque,
                    sinkage_m: sinkage,
                    lateral_force_n: lateral,
                    is_refused,
                },
            },
        );
        Ok(repeats.unwrap_or_default())
    }
}
