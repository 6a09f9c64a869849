//! The members of a study as its overview shows them.

use super::compared_models::models;
use super::error::ServiceError;
use super::stored_calibration::spec_of;
use super::study_step::is_search_of;
use crate::store::Reader;
use job::{AlgorithmSettings, is_discovery};
use record::CalibrationRow;
use result::{MemberKind, Rejections, StudyMember};
use shared::api::CalibrationState;

/// The members of a study, finished or not, oldest first.
///
/// # Errors
/// [`ServiceError`] where an experiment cannot be read.
pub(super) async fn study_members(
    reader: &Reader,
    rows: &[CalibrationRow],
) -> Result<Vec<StudyMember>, ServiceError> {
    let mut members: Vec<StudyMember> = Vec::new();
    let mut submitted = Vec::new();
    // A job that this version does not understand compares nothing.
    let models = models(rows).unwrap_or(1);
    for row in rows.iter().filter(|row| !is_discovery(&row.job.toml)) {
        // A job that this version does not understand stays in the list, with nothing said of its model.
        let (kind, parts) = match spec_of(reader, row).await {
            Ok(spec) => {
                let effects = spec.fit_variant.effects.iter().map(|e| e.name.clone());
                let parts: Vec<String> = effects.chain(spec.freed()).collect();
                (kind_of(&spec.algorithm), parts)
            }
            Err(ServiceError::File(_)) => (MemberKind::Sample, Vec::new()),
            Err(error) => return Err(error),
        };
        // A model to compare has nothing beyond the submitted job: it is part of it.
        if members.len() < models {
            submitted.extend(parts.iter().cloned());
        }
        let effects = parts.into_iter().filter(|part| !submitted.contains(part));
        let member = member(row, kind, effects.collect(), None);
        members.push(with_rejections(reader, member).await?);
    }
    for row in rows.iter().filter(|row| is_discovery(&row.job.toml)) {
        let searches = searched_by(row, rows)?;
        let searched = members.iter().find(|member| Some(member.id) == searches);
        let effects = searched.map(|member| member.effects.clone());
        members.push(member(
            row,
            MemberKind::Search,
            effects.unwrap_or_default(),
            searches,
        ));
    }
    members.sort_by_key(|member| member.id);
    Ok(members)
}

fn member(
    row: &CalibrationRow,
    kind: MemberKind,
    effects: Vec<String>,
    searches: Option<i64>,
) -> StudyMember {
    StudyMember {
        id: row.id,
        name: row.name.clone(),
        state: row.state,
        kind,
        effects,
        searches,
        message: row.message.clone(),
        rejections: None,
    }
}

/// The member; with what the model rejected where it failed.
async fn with_rejections(reader: &Reader, member: StudyMember) -> Result<StudyMember, ServiceError> {
    let rejections = match member.state {
        CalibrationState::Failed => Some(Rejections {
            kinds: reader.rejections(member.id).await?,
            first: reader.first_rejection(member.id).await?,
        }),
        _ => None,
    };
    Ok(StudyMember { rejections, ..member })
}

fn kind_of(algorithm: &AlgorithmSettings) -> MemberKind {
    match algorithm {
        AlgorithmSettings::Sample(_) => MemberKind::Sample,
        AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) => MemberKind::Fit,
        AlgorithmSettings::Discover { .. } => MemberKind::Search,
    }
}

/// The calibration whose model a search is about: the first of those that have the same.
pub(super) fn searched_by(
    search: &CalibrationRow,
    study: &[CalibrationRow],
) -> Result<Option<i64>, ServiceError> {
    for row in study.iter().filter(|row| !is_discovery(&row.job.toml)) {
        if is_search_of(search, row)? {
            return Ok(Some(row.id));
        }
    }
    Ok(None)
}
