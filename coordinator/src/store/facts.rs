//! One statement for each kind of fact but evaluations, which go in groups.

use std::sync::atomic::Ordering;

use inference::point_estimate::ModeEstimate;
use inference::{Particle, StageRecord};
use sqlx::{QueryBuilder, Sqlite, SqliteConnection};

use super::blob;
use super::health::StoreHealth;
use super::json::json;
use super::repeats;
use super::verification;
use record::fact::{Fact, Fingerprint};

/// Most samples in one statement.
const ROWS: usize = 4000;

/// Writes a fact within the present transaction. Stages and states may be told twice, after a restart.
pub(super) async fn write(
    connection: &mut SqliteConnection,
    fact: Fact,
    health: &StoreHealth,
) -> Result<(), sqlx::Error> {
    match fact {
        Fact::Evaluated { .. } => unreachable!("evaluations go in groups"),
        Fact::Duplicate {
            calibration,
            evaluation,
            fingerprint,
            worker,
        } => compare(connection, calibration, evaluation, fingerprint, &worker, health).await,
        Fact::Stage {
            calibration,
            record,
            busy_ms,
        } => {
            stage(connection, calibration, &record).await?;
            busy(connection, calibration, busy_ms).await
        }
        Fact::Posterior {
            calibration,
            posterior,
        } => sqlx::query(
            "UPDATE calibrations SET log_evidence = ?, log_evidence_se = ?, equilibrated = ?,
             evaluations = ?, rejected = ? WHERE id = ?",
        )
        .bind(posterior.log_evidence)
        .bind(posterior.log_evidence_se)
        .bind(posterior.equilibrated)
        .bind(posterior.evaluations as i64)
        .bind(posterior.rejected as i64)
        .bind(calibration)
        .execute(connection)
        .await
        .map(drop),
        Fact::Estimate {
            calibration,
            estimate,
        } => self::estimate(connection, calibration, &estimate).await,
        Fact::Discovery { calibration, record } => {
            sqlx::query("INSERT OR REPLACE INTO discoveries (calibration, record) VALUES (?, ?)")
                .bind(calibration)
                .bind(json(&*record))
                .execute(connection)
                .await
                .map(drop)
        }
        Fact::State {
            calibration,
            state,
            message,
            busy_ms,
        } => {
            let name: Option<String> = sqlx::query_scalar(
                "UPDATE calibrations SET state = ?, message = ? WHERE id = ? RETURNING name",
            )
            .bind(state.name())
            .bind(&message)
            .bind(calibration)
            .fetch_optional(&mut *connection)
            .await?;
            tracing::info!(target: "journal", calibration, name, reason = message, "{}", state.name());
            busy(connection, calibration, busy_ms).await
        }
        Fact::Confirmed {
            calibration,
            evaluation,
            worker,
        } => verification::confirm(connection, calibration, evaluation, &worker).await,
        Fact::Quarantined {
            worker,
            calibration,
            evaluation,
        } => verification::quarantine(connection, &worker, calibration, evaluation).await,
        Fact::Rewound {
            calibration,
            worker,
            width,
        } => verification::rewind(connection, calibration, &worker, width).await,
        Fact::Repeated {
            calibration,
            repeated,
        } => repeats::add(connection, calibration, &repeated).await,
        Fact::ModelVersion { calibration, version } => {
            sqlx::query("UPDATE calibrations SET model_version = ? WHERE id = ?")
                .bind(version)
                .bind(calibration)
                .execute(connection)
                .await
                .map(drop)
        }
        Fact::Fault {
            calibration,
            evaluation,
            attempt,
            worker,
            message,
        } => sqlx::query(
            "INSERT INTO faults (calibration, evaluation, attempt, worker, message, at_ms)
             VALUES (?, ?, ?, ?, ?, unixepoch('subsec') * 1000)",
        )
        .bind(calibration)
        .bind(evaluation as i64)
        .bind(attempt)
        .bind(worker)
        .bind(message)
        .execute(connection)
        .await
        .map(drop),
    }
}

async fn busy(connection: &mut SqliteConnection, calibration: i64, busy_ms: u64) -> Result<(), sqlx::Error> {
    sqlx::query("UPDATE calibrations SET busy_ms = ? WHERE id = ?")
        .bind(busy_ms as i64)
        .bind(calibration)
        .execute(connection)
        .await
        .map(drop)
}

async fn stage(
    connection: &mut SqliteConnection,
    calibration: i64,
    s: &StageRecord,
) -> Result<(), sqlx::Error> {
    sqlx::query(
        "INSERT OR REPLACE INTO stages (calibration, stage, tempering_exponent, acceptance, drift_z, correlation,
         steps, log_evidence_increment, weight_cov, ess, scale, evaluations, equilibrated)
         VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
    )
    .bind(calibration)
    .bind(s.stage as i64)
    .bind(s.tempering_exponent)
    .bind(s.acceptance)
    .bind(s.drift_z)
    .bind(s.correlation)
    .bind(s.steps as i64)
    .bind(s.log_evidence_increment)
    .bind(s.weight_cov)
    .bind(s.ess)
    .bind(s.scale)
    .bind(s.evaluations as i64)
    .bind(s.equilibrated)
    .execute(&mut *connection)
    .await?;
    samples(connection, (calibration, s.stage), &s.population).await
}

async fn samples(
    connection: &mut SqliteConnection,
    (calibration, stage): (i64, usize),
    population: &[Particle],
) -> Result<(), sqlx::Error> {
    for (part, particles) in population.chunks(ROWS).enumerate() {
        let mut query: QueryBuilder<Sqlite> = QueryBuilder::new(
            "INSERT OR REPLACE INTO samples (calibration, stage, particle, theta, log_likelihood, log_prior) ",
        );
        query.push_values(particles.iter().enumerate(), |mut values, (k, particle)| {
            let log_likelihood = Some(particle.log_likelihood.value()).filter(|l| l.is_finite());
            values
                .push_bind(calibration)
                .push_bind(stage as i64)
                .push_bind((part * ROWS + k) as i64)
                .push_bind(blob::encode(&particle.theta))
                .push_bind(log_likelihood)
                .push_bind(particle.log_prior);
        });
        query.build().persistent(false).execute(&mut *connection).await?;
    }
    Ok(())
}

async fn estimate(
    connection: &mut SqliteConnection,
    calibration: i64,
    e: &ModeEstimate,
) -> Result<(), sqlx::Error> {
    let history: Vec<(u64, Option<f64>, Option<f64>)> = e
        .history
        .iter()
        .map(|g| (g.evaluations, g.best, g.mean))
        .collect();
    sqlx::query(
        "INSERT OR REPLACE INTO estimates (calibration, theta, log_likelihood, log_prior, sd, at_bound, stop, history)
         VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
    )
    .bind(calibration)
    .bind(json(&e.theta))
    .bind(e.log_likelihood)
    .bind(e.log_prior)
    .bind(e.laplace.as_ref().map(|laplace| json(&laplace.sd)))
    .bind(json(&e.at_bound))
    .bind(e.stop.name())
    .bind(json(&history))
    .execute(&mut *connection)
    .await?;
    if let Some(approximation) = &e.approximation {
        // Draws that belong to no stage: there is no other population.
        samples(connection, (calibration, 0), &approximation.draws).await?;
    }
    sqlx::query("UPDATE calibrations SET log_evidence = ?, evaluations = ?, rejected = ? WHERE id = ?")
        .bind(
            e.approximation
                .as_ref()
                .map(|approximation| approximation.log_evidence),
        )
        .bind(e.evaluations as i64)
        .bind(e.rejected as i64)
        .bind(calibration)
        .execute(connection)
        .await
        .map(drop)
}

/// Compares a late duplicate with what is stored: two machines must give the same bits.
async fn compare(
    connection: &mut SqliteConnection,
    calibration: i64,
    evaluation: u64,
    fingerprint: Fingerprint,
    second: &str,
    health: &StoreHealth,
) -> Result<(), sqlx::Error> {
    let stored: Option<(i64, String)> = sqlx::query_as(
        "SELECT fingerprint, worker FROM evaluations WHERE calibration = ? AND evaluation = ?",
    )
    .bind(calibration)
    .bind(evaluation as i64)
    .fetch_optional(&mut *connection)
    .await?;
    match stored {
        None => tracing::warn!(
            calibration,
            evaluation,
            worker = second,
            "result of an unknown evaluation"
        ),
        Some((same, _)) if same == fingerprint.0 => {}
        // Given up after faults: there is no answer to compare with.
        Some((_, nobody)) if nobody.is_empty() => {}
        Some((_, first)) => {
            health.differing_duplicates.fetch_add(1, Ordering::Relaxed);
            tracing::error!(
                calibration,
                evaluation,
                first,
                second,
                "two workers returned different results for the same evaluation: the farm is not deterministic"
            );
            sqlx::query(
                "INSERT OR IGNORE INTO disputes (calibration, evaluation, first, second, at_ms)
                 VALUES (?, ?, ?, ?, unixepoch('subsec') * 1000)",
            )
            .bind(calibration)
            .bind(evaluation as i64)
            .bind(first)
            .bind(second)
            .execute(&mut *connection)
            .await?;
            // What the study ended with says nothing of it yet.
            sqlx::query("DELETE FROM results WHERE study = (SELECT study FROM calibrations WHERE id = ?)")
                .bind(calibration)
                .execute(&mut *connection)
                .await?;
        }
    }
    Ok(())
}
