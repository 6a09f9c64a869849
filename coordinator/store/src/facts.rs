//! The statements that write facts: one for each kind of fact. Evaluations are inserted in groups instead.

use std::sync::atomic::Ordering;

use inference::point_estimate::ModeEstimate;
use inference::{Particle, StageRecord};

use super::blob;
use super::checksum::{SAMPLES, STAGES};
use super::health::StoreHealth;
use super::json::json;
use super::repeats;
use super::sql::{Conflict, Connection, Value, insert, query, query_as, query_scalar};
use super::verification;
use record::fact::{Fact, Fingerprint};

/// The largest number of samples in one statement.
const ROWS: usize = 4000;
/// The conflict rule of tables that have one row for each calibration: a new row replaces the old one.
const ITS_OWN: Conflict<'static> = Conflict::Replace(&["calibration"]);

/// Writes a fact within the present transaction. Stages and states may be written again after a restart. Returns whether the fact makes
/// results of studies out of date.
pub(super) async fn write(
    connection: &mut Connection,
    fact: Fact,
    health: &StoreHealth,
) -> Result<bool, sqlx::Error> {
    let raises_doubts = matches!(fact, Fact::Quarantined { .. } | Fact::Rewound { .. });
    let written = match fact {
        Fact::Evaluated { .. } => unreachable!("evaluations go in groups"),
        // The writer drops them in later commits.
        Fact::ValuesExpired { .. } => Ok(()),
        Fact::Duplicate {
            calibration,
            evaluation,
            fingerprint,
            worker,
        } => return compare(connection, calibration, evaluation, fingerprint, &worker, health).await,
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
            emulator,
        } => {
            if let Some(record) = emulator {
                let row = vec![calibration.into(), json(&*record).into()];
                insert("emulators", &["calibration", "record"], vec![row], &ITS_OWN)
                    .execute(&mut *connection)
                    .await?;
            }
            query(
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
            .map(drop)
        }
        Fact::Estimate {
            calibration,
            estimate,
        } => self::estimate(connection, calibration, &estimate).await,
        Fact::Discovery { calibration, record } => {
            let row = vec![calibration.into(), json(&*record).into()];
            insert("discoveries", &["calibration", "record"], vec![row], &ITS_OWN)
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
            let name: Option<String> =
                query_scalar("UPDATE calibrations SET state = ?, message = ? WHERE id = ? RETURNING name")
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
            query("UPDATE calibrations SET model_version = ? WHERE id = ?")
                .bind(version)
                .bind(calibration)
                .execute(connection)
                .await
                .map(drop)
        }
        Fact::Repinned { calibration, version } => {
            verification::repin(connection, calibration, &version).await
        }
        Fact::Fault {
            calibration,
            evaluation,
            attempt,
            worker,
            message,
        } => query(
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
    };
    written.map(|()| raises_doubts)
}

async fn busy(connection: &mut Connection, calibration: i64, busy_ms: u64) -> Result<(), sqlx::Error> {
    query("UPDATE calibrations SET busy_ms = ? WHERE id = ?")
        .bind(busy_ms as i64)
        .bind(calibration)
        .execute(connection)
        .await
        .map(drop)
}

async fn stage(connection: &mut Connection, calibration: i64, s: &StageRecord) -> Result<(), sqlx::Error> {
    let row = STAGES.sealed(vec![
        calibration.into(),
        (s.stage as i64).into(),
        s.tempering_exponent.into(),
        s.acceptance.into(),
        s.drift_z.into(),
        s.correlation.into(),
        (s.steps as i64).into(),
        s.log_evidence_increment.into(),
        s.weight_cov.into(),
        s.ess.into(),
        s.scale.into(),
        (s.evaluations as i64).into(),
        s.equilibrated.into(),
    ]);
    insert(
        "stages",
        &STAGES.names(),
        vec![row],
        &Conflict::Replace(&["calibration", "stage"]),
    )
    .execute(&mut *connection)
    .await?;
    samples(connection, (calibration, s.stage), &s.population).await
}

async fn samples(
    connection: &mut Connection,
    (calibration, stage): (i64, usize),
    population: &[Particle],
) -> Result<(), sqlx::Error> {
    for (part, particles) in population.chunks(ROWS).enumerate() {
        let rows = particles.iter().enumerate().map(|(k, particle)| {
            let log_likelihood = Some(particle.log_likelihood.value()).filter(|l| l.is_finite());
            SAMPLES.sealed(vec![
                calibration.into(),
                (stage as i64).into(),
                ((part * ROWS + k) as i64).into(),
                blob::encode(&particle.theta).into(),
                log_likelihood.into(),
                particle.log_prior.into(),
            ])
        });
        let key = Conflict::Replace(&["calibration", "stage", "particle"]);
        insert("samples", &SAMPLES.names(), rows.collect(), &key)
            .execute(&mut *connection)
            .await?;
    }
    Ok(())
}

async fn estimate(
    connection: &mut Connection,
    calibration: i64,
    e: &ModeEstimate,
) -> Result<(), sqlx::Error> {
    let history: Vec<(u64, Option<f64>, Option<f64>)> = e
        .history
        .iter()
        .map(|g| (g.evaluations, g.best, g.mean))
        .collect();
    let columns = [
        ("calibration", calibration.into()),
        ("theta", json(&e.theta).into()),
        ("log_likelihood", e.log_likelihood.into()),
        ("log_prior", e.log_prior.into()),
        ("sd", e.laplace.as_ref().map(|laplace| json(&laplace.sd)).into()),
        ("at_bound", json(&e.at_bound).into()),
        ("stop", e.stop.name().into()),
        ("history", json(&history).into()),
    ];
    let (names, row): (Vec<&str>, Vec<Value>) = columns.into_iter().unzip();
    insert("estimates", &names, vec![row], &ITS_OWN)
        .execute(&mut *connection)
        .await?;
    if let Some(approximation) = &e.approximation {
        // A fit has no stages, so its draws are stored under stage 0.
        samples(connection, (calibration, 0), &approximation.draws).await?;
    }
    query("UPDATE calibrations SET log_evidence = ?, evaluations = ?, rejected = ? WHERE id = ?")
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

/// Compares a late duplicate with the stored result: two machines must give the same bits. Returns whether a new dispute is stored.
async fn compare(
    connection: &mut Connection,
    calibration: i64,
    evaluation: u64,
    fingerprint: Fingerprint,
    second: &str,
    health: &StoreHealth,
) -> Result<bool, sqlx::Error> {
    let stored: Option<(i64, String)> =
        query_as("SELECT fingerprint, worker FROM evaluations WHERE calibration = ? AND evaluation = ?")
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
        // The evaluation was given up after faults, so there is no answer to compare with.
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
            let inserted = query(
                "INSERT INTO disputes (calibration, evaluation, first, second, at_ms)
                 VALUES (?, ?, ?, ?, unixepoch('subsec') * 1000) ON CONFLICT DO NOTHING",
            )
            .bind(calibration)
            .bind(evaluation as i64)
            .bind(first)
            .bind(second)
            .execute(&mut *connection)
            .await?;
            if inserted == 0 {
                return Ok(false);
            }
            // The stored results of the study do not mention the dispute.
            query("DELETE FROM results WHERE study = (SELECT study FROM calibrations WHERE id = ?)")
                .bind(calibration)
                .execute(&mut *connection)
                .await?;
            return Ok(true);
        }
    }
    Ok(false)
}
