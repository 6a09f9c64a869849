//! The overviews of studies that are kept in memory.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use report::StudyOverview;
use shared::api::CalibrationState;

/// The overviews that were shown, by study: those of finished studies are computed once for each build of the program, those of others
/// whenever a member begins or ends.
#[derive(Debug, Clone, Default)]
pub(super) struct Overviews(Arc<Mutex<BTreeMap<i64, KeptOverview>>>);

#[derive(Debug, Clone)]
pub(super) struct KeptOverview {
    /// The members that it was made from.
    pub(super) members: MemberKey,
    /// Disputes and quarantined workers when it was made: flags name them.
    pub(super) doubts: (i64, i64),
    pub(super) overview: Arc<StudyOverview>,
}

/// Ids of the members that are over, and the number of all.
pub(super) type MemberKey = (Vec<i64>, usize);

impl Overviews {
    pub(super) fn get(&self, study: i64, members: &MemberKey) -> Option<KeptOverview> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get(&study).filter(|kept| kept.members == *members).cloned()
    }

    pub(super) fn keep(&self, study: i64, own: KeptOverview) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.insert(study, own);
    }

    pub(super) fn forget_all_but(&self, studies: &BTreeMap<i64, MemberKey>) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|study, _| studies.contains_key(study));
    }
}

/// What an overview of these members is kept under.
pub(super) fn member_key(members: impl Iterator<Item = (i64, CalibrationState)>) -> MemberKey {
    let (mut over, mut count) = (Vec::new(), 0);
    for (id, state) in members {
        count += 1;
        if state.is_final() {
            over.push(id);
        }
    }
    (over, count)
}
