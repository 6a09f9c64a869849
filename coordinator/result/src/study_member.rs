//! A member of a study, finished or not.

use record::Role;
use shared::api::CalibrationState;

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
}
