//! A member of a study: a calibration or a search, finished or not.

use std::collections::BTreeMap;

use record::Role;
use shared::api::CalibrationState;

use crate::words::number;
use crate::words::rejection::rejection_counts;

/// A calibration or a search of a study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyMember {
    /// Id of the member.
    pub id: i64,
    /// Name of the member.
    pub name: String,
    /// State of the member.
    pub state: CalibrationState,
    /// Role in the study.
    pub kind: Role,
    /// Effects (`EFFECT.WHEEL` if one wheel of several has it) and freed parameters of its model that the submitted job does not have.
    pub effects: Vec<String>,
    /// The calibration whose model the member searches; null for a sample or a fit.
    pub searches: Option<i64>,
    /// Reason for a pause or a failure.
    pub message: Option<String>,
    /// Rejections by the model; null unless the member failed.
    pub rejections: Option<Rejections>,
}

/// Counts of the parameter vectors that the model rejected.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Rejections {
    /// Number of rejections by kind.
    pub kinds: BTreeMap<String, u64>,
    /// Message of the first rejection.
    pub first: Option<String>,
}

impl Rejections {
    /// Returns the most frequent kind; of several equally frequent kinds, the first.
    pub fn usual(&self) -> Option<&str> {
        let kinds = self.kinds.iter().rev();
        kinds
            .max_by_key(|(_, count)| **count)
            .map(|(kind, _)| kind.as_str())
    }

    /// Counts the rejections by kind with an example, such as `the soil does not carry the load (no_support, 1000), such as "the soil
    /// carries at most 80 N of the 140 N wheel load"`; `None` without rejections.
    pub fn words(&self) -> Option<String> {
        let kinds = rejection_counts(&self.kinds);
        let first = self.first.as_ref().map(|first| format!(", such as \"{first}\""));
        (!kinds.is_empty()).then(|| format!("{}{}", number::list(&kinds), first.unwrap_or_default()))
    }
}
