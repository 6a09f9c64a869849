//! Queries for results and lists.

use std::collections::BTreeMap;

use inference::point_estimate::{Generation, StopReason};
use inference::{EmulatorRecord, Particle};
use shared::api::CalibrationState;
use shared::file::FileSet;
use shared::outcome::Observables;
use statistics::LogLikelihood;

use super::blob;
use super::checksum::{EVALUATIONS, SAMPLES, STAGES};
use super::error::StoreError;
use super::json::{file_map, json, numbers};
use super::members::{Filled, JOB};
use super::observables;
use super::reader::Reader;
use super::sql::{Pool, Row, query, query_as, query_scalar};
use super::theta::theta;
use job::without_metamodel;
use record::{
    CalibrationRow, Discovery, EstimateRow, EvaluationKey, ExperimentRow, LIKELIEST, Membership,
    PREDICTIONS_FROM, Prediction, RejectionReason, Role, StageRow,
};

pub(super) const CALIBRATION: &str = "SELECT c.*, coalesce(c.experiment, s.experiment) AS on_experiment
     FROM calibrations c JOIN studies s ON s.id = c.study";

/// A study with its members.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredStudy {
    /// Id of the study.
    pub id: i64,
    /// The experiment that it is about.
    pub experiment: i64,
    /// Ids of the study's calibrations, oldest first.
    pub calibrations: Vec<i64>,
}

/// The address that a calibration's pauses and ends are posted to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredWebhook {
    /// Id of the study.
    pub study: i64,
    /// Name of the calibration.
    pub name: String,
    /// URL of the web hook.
    pub url: String,
}

impl Reader {
    /// Reads the web hook of a calibration's study, if it has one.
    pub async fn webhook(&self, calibration: i64) -> Result<Option<StoredWebhook>, StoreError> {
        let row = query(
            "SELECT s.id, c.name, s.webhook FROM calibrations c JOIN studies s ON s.id = c.study
             WHERE c.id = ? AND s.webhook IS NOT NULL",
        )
        .bind(calibration)
        .fetch_optional(&self.pool)
        .await?;
        row.map(|row| {
            Ok(StoredWebhook {
                study: row.try_get("id")?,
                name: row.try_get("name")?,
                url: row.try_get("webhook")?,
            })
        })
        .transpose()
    }

    /// Reads the number of calibrations in each state, by the name of the state.
    pub async fn states(&self) -> Result<Vec<(String, i64)>, StoreError> {
        let states = query_as("SELECT state, count(*) FROM calibrations GROUP BY state");
        Ok(states.fetch_all(&self.pool).await?)
    }

    /// Reads an experiment.
    pub async fn experiment(&self, id: i64) -> Result<Option<ExperimentRow>, StoreError> {
        let row = query("SELECT toml, files FROM experiments WHERE id = ?")
            .bind(id)
            .fetch_optional(&self.pool)
            .await?;
        row.map(|row| {
            let files = file_map(row.get("files"))?;
            Ok(ExperimentRow {
                id,
                files: FileSet {
                    toml: row.get("toml"),
                    files,
                },
            })
        })
        .transpose()
    }

    /// Reads a calibration.
    pub async fn calibration(&self, id: i64) -> Result<Option<CalibrationRow>, StoreError> {
        let sql = format!("{CALIBRATION} WHERE c.id = ?");
        let row = query(sqlx::AssertSqlSafe(sql))
            .bind(id)
            .fetch_optional(&self.pool)
            .await?;
        row.as_ref().map(|row| self.calibration_row(row)).transpose()
    }

    /// Reads the calibrations of a study, oldest first.
    pub async fn study(&self, id: i64) -> Result<Vec<CalibrationRow>, StoreError> {
        let sql = format!("{CALIBRATION} WHERE c.study = ? ORDER BY c.id");
        let rows = query(sqlx::AssertSqlSafe(sql))
            .bind(id)
            .fetch_all(&self.pool)
            .await?;
        rows.iter().map(|row| self.calibration_row(row)).collect()
    }

    /// Reads all studies, oldest first.
    pub async fn studies(&self) -> Result<Vec<StoredStudy>, StoreError> {
        let rows: Vec<(i64, i64, i64)> = query_as(
            "SELECT s.id, s.experiment, c.id FROM studies s JOIN calibrations c ON c.study = s.id ORDER BY s.id, c.id",
        )
        .fetch_all(&self.pool)
        .await?;
        let mut studies: Vec<StoredStudy> = Vec::new();
        for (id, experiment, calibration) in rows {
            match studies.last_mut() {
                Some(last) if last.id == id => last.calibrations.push(calibration),
                _ => studies.push(StoredStudy {
                    id,
                    experiment,
                    calibrations: vec![calibration],
                }),
            }
        }
        Ok(studies)
    }

    /// Reads the study, id and state of every calibration that is part of its study, oldest first.
    pub async fn member_states(&self) -> Result<Vec<(i64, i64, CalibrationState)>, StoreError> {
        let rows = query("SELECT study, id, state FROM calibrations ORDER BY id");
        let rows = rows.fetch_all(&self.pool).await?;
        // An unreadable state is reported where the calibration is requested.
        let readable = |row: &Row| {
            let state = CalibrationState::from_name(row.try_get("state").ok()?)?;
            Some((row.try_get("study").ok()?, row.try_get("id").ok()?, state))
        };
        let withdrawn = self.withdrawn().await?;
        let is_part = |(_, id, _): &(i64, i64, CalibrationState)| !withdrawn.contains(id);
        Ok(rows.iter().filter_map(readable).filter(is_part).collect())
    }

    /// Reads the studies whose calibrations are all over, each with the number of its calibrations; archived studies are left out.
    pub async fn finished_studies(&self) -> Result<Vec<(i64, i64)>, StoreError> {
        let rows = query(
            "SELECT study, count(*) AS members FROM calibrations c JOIN studies s ON s.id = c.study
             WHERE s.archived_at_ms IS NULL GROUP BY study
             HAVING sum(CASE WHEN state IN ('finished', 'failed', 'cancelled') THEN 0 ELSE 1 END) = 0 ORDER BY study",
        )
        .fetch_all(&self.pool)
        .await?;
        Ok(rows
            .iter()
            .map(|row| (row.get("study"), row.get("members")))
            .collect())
    }

    /// Reads the stages of a calibration, in order.
    pub async fn stages(&self, calibration: i64) -> Result<Vec<StageRow>, StoreError> {
        let rows = query("SELECT * FROM stages WHERE calibration = ? ORDER BY stage")
            .bind(calibration)
            .fetch_all(&self.pool)
            .await?;
        let stage = |row: &Row| {
            STAGES.verify(row)?;
            Ok(StageRow {
                stage: small(row, "stage")?,
                tempering_exponent: row.get("tempering_exponent"),
                acceptance: row.get("acceptance"),
                drift_z: row.get("drift_z"),
                correlation: row.get("correlation"),
                steps: small(row, "steps")?,
                log_evidence_increment: row.get("log_evidence_increment"),
                weight_cov: row.get("weight_cov"),
                ess: row.get("ess"),
                scale: row.get("scale"),
                evaluations: row.get::<i64>("evaluations").unsigned_abs(),
                equilibrated: row.get("equilibrated"),
            })
        };
        rows.iter().map(stage).collect()
    }

    /// Reads the population at the end of a stage, or of the last one.
    pub async fn samples(&self, calibration: i64, stage: Option<u32>) -> Result<Vec<Particle>, StoreError> {
        let rows = query(
            "SELECT * FROM samples WHERE calibration = ?1
             AND stage = coalesce(?2, (SELECT max(stage) FROM samples WHERE calibration = ?1)) ORDER BY particle",
        )
        .bind(calibration)
        .bind(stage)
        .fetch_all(&self.pool)
        .await?;
        rows.iter().map(particle).collect()
    }

    /// Reads at most `max` equally spaced draws of the population at the end of a stage, or of the last one, and the size of the
    /// population.
    ///
    /// Takes m of n draws: those k with floor((k + 1) m / n) > floor(k m / n).
    pub async fn thinned_samples(
        &self,
        calibration: i64,
        stage: Option<u32>,
        max: u32,
    ) -> Result<(Vec<Particle>, u64), StoreError> {
        let population = "FROM samples WHERE calibration = ?1
             AND stage = coalesce(?2, (SELECT max(stage) FROM samples WHERE calibration = ?1))";
        let count = format!("SELECT count(*) {population}");
        let count: i64 = query_scalar(sqlx::AssertSqlSafe(count))
            .bind(calibration)
            .bind(stage)
            .fetch_one(&self.pool)
            .await?;
        let taken = format!(
            "SELECT * {population}
             AND (particle + 1) * ?3 / ?4 > particle * ?3 / ?4 ORDER BY particle"
        );
        let rows = query(sqlx::AssertSqlSafe(taken))
            .bind(calibration)
            .bind(stage)
            .bind(i64::from(max).min(count))
            .bind(count.max(1))
            .fetch_all(&self.pool)
            .await?;
        let samples: Result<Vec<Particle>, StoreError> = rows.iter().map(particle).collect();
        Ok((samples?, count.unsigned_abs()))
    }

    /// Reads the populations at the end of every stage, in order.
    pub async fn populations(&self, calibration: i64) -> Result<Vec<Vec<Particle>>, StoreError> {
        let mut populations = Vec::new();
        for stage in self.stages(calibration).await? {
            populations.push(self.samples(calibration, Some(stage.stage)).await?);
        }
        Ok(populations)
    }

    /// Reads the predicted values that the likelihood used for a parameter vector while sampling; `None` where it was not simulated then,
    /// or was rejected.
    ///
    /// Only stores of before migration 9, which kept the values of every evaluation, need this query.
    pub async fn fitted_values(
        &self,
        calibration: i64,
        theta: &[f64],
    ) -> Result<Option<Vec<f64>>, StoreError> {
        let row = query(
            "SELECT fitted FROM evaluations
             WHERE calibration = ? AND theta = ? AND length(fitted) > 0 ORDER BY evaluation LIMIT 1",
        )
        .bind(calibration);
        // A file keeps such a vector as text. A server got it from a copy, which converts it to bytes.
        let row = match self.pool {
            Pool::Sqlite(_) => row.bind(json(theta)),
            Pool::Postgres(_) => row.bind(blob::encode(theta)),
        };
        let row = row.fetch_optional(&self.pool).await?;
        row.map(|row| blob::decode_values(row.get("fitted"))).transpose()
    }

    /// Reads the result of a fit.
    pub async fn estimate(&self, calibration: i64) -> Result<Option<EstimateRow>, StoreError> {
        let row = query("SELECT * FROM estimates WHERE calibration = ?")
            .bind(calibration)
            .fetch_optional(&self.pool)
            .await?;
        row.map(|row| {
            let stop: &str = row.get("stop");
            let history = array::<(u64, Option<f64>, Option<f64>)>(row.get("history"))?;
            let generation = |(evaluations, best, mean)| Generation {
                evaluations,
                best,
                mean,
            };
            Ok(EstimateRow {
                theta: numbers(row.get("theta"))?,
                log_likelihood: row.get("log_likelihood"),
                log_prior: row.get("log_prior"),
                sd: row.get::<Option<&str>>("sd").map(array).transpose()?,
                at_bound: array(row.get("at_bound"))?,
                stop: StopReason::from_name(stop)
                    .ok_or_else(|| StoreError::Corrupt(format!("stop {stop}")))?,
                history: history.into_iter().map(generation).collect(),
            })
        })
        .transpose()
    }

    /// Reads what a sampler found about its emulator. A store of before migration 22 has none.
    pub async fn emulator(&self, calibration: i64) -> Result<Option<EmulatorRecord>, StoreError> {
        if !self.has_table("emulators").await? {
            return Ok(None);
        }
        let record: Option<String> = query_scalar("SELECT record FROM emulators WHERE calibration = ?")
            .bind(calibration)
            .fetch_optional(&self.pool)
            .await?;
        let read = |json: String| {
            serde_json::from_str(&json)
                .map_err(|e| StoreError::Corrupt(format!("record of emulator {calibration}: {e}")))
        };
        record.map(read).transpose()
    }

    /// Reads the result of a search for a missing effect.
    pub async fn discovery(&self, calibration: i64) -> Result<Option<Discovery>, StoreError> {
        let record: Option<String> = query_scalar("SELECT record FROM discoveries WHERE calibration = ?")
            .bind(calibration)
            .fetch_optional(&self.pool)
            .await?;
        record.map(|json| discovery_of(calibration, &json)).transpose()
    }

    /// Reads the records of all searches whose texts contain a name, by search.
    pub async fn discoveries_with(&self, name: &str) -> Result<Vec<(i64, Discovery)>, StoreError> {
        let rows = query_as(
            "SELECT calibration, record FROM discoveries WHERE record LIKE '%' || ? || '%' ORDER BY calibration",
        );
        let rows: Vec<(i64, String)> = rows.bind(format!("\"{name}\"")).fetch_all(&self.pool).await?;
        let read = |(search, json): (i64, String)| Ok((search, discovery_of(search, &json)?));
        rows.into_iter().map(read).collect()
    }

    /// Reads the final draws of a calibration. The first is the most probable particle; a fit without draws has only this one.
    pub async fn predictions(&self, calibration: i64) -> Result<Vec<Prediction>, StoreError> {
        let rows = query(
            "SELECT * FROM evaluations
             WHERE calibration = ? AND evaluation >= ? AND evaluation <> ? ORDER BY evaluation",
        )
        .bind(calibration)
        .bind(PREDICTIONS_FROM as i64)
        .bind(LIKELIEST as i64)
        .fetch_all(&self.pool)
        .await?;
        let mut predictions: Vec<Prediction> = Vec::new();
        for row in &rows {
            EVALUATIONS.verify(row)?;
            let result = match row.get::<Option<String>>("rejection") {
                Some(rejection) => Err(RejectionReason(rejection)),
                None => Ok(observables::decode(row.get("observables"))?),
            };
            let number = row.get::<i64>("evaluation").unsigned_abs();
            match EvaluationKey::from_number(number, 1) {
                EvaluationKey::Prediction { holdout: true, .. } => {
                    if let Some(last) = predictions.last_mut() {
                        last.holdout = Some(result.into());
                    }
                }
                EvaluationKey::HoldoutRun { draw, run } => {
                    let of_draw = predictions.get_mut(draw).and_then(|p| p.holdout.as_mut());
                    if let Some(holdout) = of_draw {
                        holdout.alone.insert(run, result);
                    }
                }
                EvaluationKey::Prediction { .. }
                | EvaluationKey::Sampling { .. }
                | EvaluationKey::Likeliest => {
                    predictions.push(Prediction {
                        theta: theta(row)?,
                        fit: result,
                        holdout: None,
                    });
                }
            }
        }
        Ok(predictions)
    }

    /// Reads the fitted runs at the likeliest parameters, with their histories where the model has a time axis; `None` where they were not
    /// simulated once more, or were rejected.
    pub async fn likeliest(&self, calibration: i64) -> Result<Option<Observables>, StoreError> {
        let row = query(
            "SELECT * FROM evaluations WHERE calibration = ? AND evaluation = ? AND observables IS NOT NULL",
        )
        .bind(calibration)
        .bind(LIKELIEST as i64)
        .fetch_optional(&self.pool)
        .await?;
        row.map(|row| {
            EVALUATIONS.verify(&row)?;
            observables::decode(row.get("observables"))
        })
        .transpose()
    }

    /// Reads how many parameter vectors of the sampler or the fit the model rejected, by the kind of rejection.
    ///
    /// Rejections of final draws are not counted; they are stored with the draws.
    pub async fn rejections(&self, calibration: i64) -> Result<BTreeMap<String, u64>, StoreError> {
        let rows = query(
            "SELECT substr(rejection, 1, instr(rejection, ':') - 1) AS kind, count(*) AS n FROM evaluations
             WHERE calibration = ? AND evaluation < ? AND rejection IS NOT NULL GROUP BY kind",
        )
        .bind(calibration)
        .bind(PREDICTIONS_FROM as i64)
        .fetch_all(&self.pool)
        .await?;
        Ok(rows
            .iter()
            .map(|row| (row.get("kind"), row.get::<i64>("n").unsigned_abs()))
            .collect())
    }

    /// Reads the message of the first rejected parameter vector of the sampler or the fit, without the kind of rejection.
    pub async fn first_rejection(&self, calibration: i64) -> Result<Option<String>, StoreError> {
        let row = query(
            "SELECT rejection FROM evaluations
             WHERE calibration = ? AND evaluation < ? AND rejection IS NOT NULL ORDER BY evaluation LIMIT 1",
        )
        .bind(calibration)
        .bind(PREDICTIONS_FROM as i64)
        .fetch_optional(&self.pool)
        .await?;
        let text: Option<String> = row.map(|row| row.get("rejection"));
        Ok(text.map(|text| match text.split_once(": ") {
            Some((_, message)) => message.to_owned(),
            None => text,
        }))
    }
}

/// Reads a number that must fit 32 bits.
fn small(row: &Row, column: &str) -> Result<u32, StoreError> {
    let value: i64 = row.try_get(column)?;
    u32::try_from(value).map_err(|_| StoreError::Corrupt(format!("{column} {value}")))
}

fn particle(row: &Row) -> Result<Particle, StoreError> {
    SAMPLES.verify(row)?;
    let log_likelihood: Option<f64> = row.try_get("log_likelihood")?;
    let log_likelihood = log_likelihood.map_or(Ok(LogLikelihood::Impossible), LogLikelihood::new);
    Ok(Particle {
        theta: theta(row)?,
        log_likelihood: log_likelihood.map_err(|error| StoreError::Corrupt(error.to_string()))?,
        log_prior: row.get("log_prior"),
    })
}

fn array<T: serde::de::DeserializeOwned>(json: &str) -> Result<Vec<T>, StoreError> {
    serde_json::from_str(json).map_err(|e| StoreError::Corrupt(format!("array {json}: {e}")))
}

impl Reader {
    /// Makes a calibration from its row. An error names the id of the row.
    pub(super) fn calibration_row(&self, row: &Row) -> Result<CalibrationRow, StoreError> {
        let id: i64 = row.try_get("id")?;
        let columns = || {
            let earlier = || self.earlier_members.as_ref()?.get(&id).cloned();
            let filled = match membership(row)? {
                Some(membership) => Some(Filled {
                    membership,
                    toml: None,
                }),
                None => earlier(),
            };
            let filled = filled.ok_or_else(|| StoreError::Corrupt("it has no role".into()))?;
            columns(id, row, filled)
        };
        columns().map_err(|error| error.within(&format!("calibration {id}")))
    }
}

/// Reads the stored place of a calibration in its study; `None` in a row that an earlier version wrote.
fn membership(row: &Row) -> Result<Option<Membership>, StoreError> {
    let role: Option<&str> = match row.try_get("role") {
        Err(sqlx::Error::ColumnNotFound(_)) => None,
        role => role?,
    };
    let Some(role) = role else { return Ok(None) };
    let change: Option<&str> = row.try_get("change")?;
    let corrupt = |e| StoreError::Corrupt(format!("change: {e}"));
    Ok(Some(Membership {
        role: Role::from_name(role).ok_or_else(|| StoreError::Corrupt(format!("role {role}")))?,
        parent: row.try_get("parent")?,
        change: change.map(serde_json::from_str).transpose().map_err(corrupt)?,
    }))
}

/// Returns the text of a stored job. Results of a metamodel are read as those of moves; a job that would go on with one is left as it
/// is, so that its reader refuses it.
fn job_text(toml: String, state: CalibrationState) -> String {
    match state.is_final() {
        true => without_metamodel(JOB, &toml).unwrap_or(toml),
        false => toml,
    }
}

/// Reads the record of a search.
fn discovery_of(search: i64, json: &str) -> Result<Discovery, StoreError> {
    serde_json::from_str(json).map_err(|e| StoreError::Corrupt(format!("record of search {search}: {e}")))
}

fn columns(id: i64, row: &Row, filled: Filled) -> Result<CalibrationRow, StoreError> {
    let state: &str = row.try_get("state")?;
    let state =
        CalibrationState::from_name(state).ok_or_else(|| StoreError::Corrupt(format!("state {state}")))?;
    let unsigned = |column| Ok::<_, StoreError>(row.try_get::<Option<i64>>(column)?.map(i64::unsigned_abs));
    Ok(CalibrationRow {
        id,
        study: row.try_get("study")?,
        experiment: row.try_get("on_experiment")?,
        name: row.try_get("name")?,
        created_ms: row.try_get("created_at_ms")?,
        membership: filled.membership,
        job: FileSet {
            toml: job_text(filled.toml.map_or_else(|| row.try_get("toml"), Ok)?, state),
            files: file_map(row.try_get("files")?)?,
        },
        state,
        message: row.try_get("message")?,
        model_version: row.try_get("model_version")?,
        busy_ms: unsigned("busy_ms")?.unwrap_or_default(),
        log_evidence: row.try_get("log_evidence")?,
        log_evidence_se: row.try_get("log_evidence_se")?,
        equilibrated: row.try_get("equilibrated")?,
        evaluations: unsigned("evaluations")?,
        rejected: unsigned("rejected")?,
    })
}
