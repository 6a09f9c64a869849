//! The members of a study as its overview shows them.

use crate::study::Lineage;
use record::{CalibrationRow, addition_name};
use result::StudyMember;

/// The members of a study, finished or not, oldest first.
pub(super) fn study_members(rows: &[CalibrationRow]) -> Vec<StudyMember> {
    let lineage = Lineage::new(rows);
    let member = |row: &CalibrationRow| {
        let searches = row.membership.parent.filter(|_| row.membership.is_search());
        let additions = lineage.additions(searches.unwrap_or(row.id));
        StudyMember {
            id: row.id,
            name: row.name.clone(),
            state: row.state,
            kind: row.membership.role,
            effects: additions.into_iter().map(addition_name).collect(),
            searches,
            message: row.message.clone(),
        }
    };
    rows.iter().map(member).collect()
}
