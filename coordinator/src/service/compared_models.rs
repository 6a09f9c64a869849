//! The models with which a study begins where its job compares several.

use super::error::ServiceError;
use crate::study::most_probable;
use job::JobFile;
use record::CalibrationRow;

/// How many models a study begins with: its first members are of those that its job compares.
pub(super) fn models(rows: &[CalibrationRow]) -> Result<usize, ServiceError> {
    let Some(lead) = rows.first() else { return Ok(1) };
    let job = JobFile::parse("job.toml", &lead.job.toml)?;
    Ok(job.models.min(rows.len()))
}

/// The compared models that a study does not go on with.
pub(super) fn passed_over(rows: &[CalibrationRow]) -> Result<Vec<i64>, ServiceError> {
    let models = models(rows)?;
    if models == 1 {
        return Ok(Vec::new());
    }
    let best = most_probable(rows[..models].iter().map(|row| row.log_evidence));
    let others = rows[..models].iter().enumerate();
    let others = others.filter(|(number, _)| Some(*number) != best);
    Ok(others.map(|(_, row)| row.id).collect())
}
