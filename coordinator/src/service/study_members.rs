//! The members of a study for its overview.

use shared::api::CalibrationState;

use super::error::ServiceError;
use crate::study::Lineage;
use record::{CalibrationRow, addition_name};
use result::{Rejections, StudyMember};
use store::Reader;

/// Reads the members of a study, finished or not, oldest first.
///
/// # Errors
/// [`ServiceError`] where the store cannot be read.
pub(super) async fn study_members(
    reader: &Reader,
    rows: &[CalibrationRow],
) -> Result<Vec<StudyMember>, ServiceError> {
    let lineage = Lineage::new(rows);
    let mut members = Vec::new();
    for row in rows {
        let searches = row.membership.parent.filter(|_| row.membership.is_search());
        let additions = lineage.additions(searches.unwrap_or(row.id));
        members.push(StudyMember {
            id: row.id,
            name: row.name.clone(),
            state: row.state,
            kind: row.membership.role,
            effects: additions.into_iter().map(addition_name).collect(),
            searches,
            message: row.message.clone(),
            rejections: rejections(reader, row).await?,
        });
    }
    Ok(members)
}

/// Counts the rejections of a failed calibration.
async fn rejections(reader: &Reader, row: &CalibrationRow) -> Result<Option<Rejections>, ServiceError> {
    if row.state != CalibrationState::Failed || row.membership.is_search() {
        return Ok(None);
    }
    Ok(Some(Rejections {
        kinds: reader.rejections(row.id).await?,
        first: reader.first_rejection(row.id).await?,
    }))
}
