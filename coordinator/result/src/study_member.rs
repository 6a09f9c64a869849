//! A member of a study, finished or not.

use std::collections::BTreeMap;

use record::Role;
use shared::api::CalibrationState;

use crate::words::number;

/// A calibration or a search of a study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyMember {
    /// Its id.
    pub id: i64,
    /// Its name.
    pub name: String,
    /// Its state.
    pub state: CalibrationState,
    /// What it computes.
    pub kind: Role,
    /// The effects (`EFFECT.WHEEL` on one wheel of several) and freed parameters of its model beyond those of the submitted job.
    pub effects: Vec<String>,
    /// The calibration whose model it searches; null of a sample or a fit.
    pub searches: Option<i64>,
    /// Why it is paused or failed.
    pub message: Option<String>,
    /// What the model rejected; null of what has not failed.
    pub rejections: Option<Rejections>,
}

/// The parameter vectors that the model rejected.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Rejections {
    /// Their number by kind.
    pub kinds: BTreeMap<String, u64>,
    /// The message of the first of them.
    pub first: Option<String>,
}

impl Rejections {
    /// The most frequent kind; the first of equals.
    pub fn usual(&self) -> Option<&str> {
        let kinds = self.kinds.iter().rev();
        kinds
            .max_by_key(|(_, count)| **count)
            .map(|(kind, _)| kind.as_str())
    }

    /// `no_support 1000, such as "the soil carries at most 80 N of the 140 N wheel load"`; `None` without any.
    pub fn words(&self) -> Option<String> {
        let kinds = self.kinds.iter().map(|(kind, count)| format!("{kind} {count}"));
        let kinds: Vec<String> = kinds.collect();
        let first = self.first.as_ref().map(|first| format!(", such as \"{first}\""));
        (!kinds.is_empty()).then(|| format!("{}{}", number::list(&kinds), first.unwrap_or_default()))
    }
}
