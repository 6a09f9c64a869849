//! What a calibration says in three sentences: what its model gets wrong, what is missing, what to do next.
//!
//! # Layout
//! - `wrong`: the errors, worst first. `pattern`: where they are.
//! - `missing`: the searches' answer. `next`: steps with their commands.

mod missing;
mod next;
mod pattern;
mod wrong;

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

pub use missing::{AddedEffect, Alternative, Missing, NamedEffect};
pub use next::{EffectFile, Next, NextStep, StepKind};
pub use wrong::{BesideInterpolation, ChannelFailure, Wrong};

/// The story of a calibration within its study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Story {
    /// The calibration.
    pub calibration: i64,
    /// Which of the models that the job compares it is, in a sentence; null where the job has one.
    pub model: Option<String>,
    /// What its model gets wrong.
    pub wrong: Wrong,
    /// What is missing, and how sure that is.
    pub missing: Missing,
    /// What to do next.
    pub next: Next,
}

impl Story {
    /// The story of a calibration of the study.
    pub fn of(study: &Study, calibration: &FinishedCalibration) -> Story {
        let wrong = Wrong::of(study, calibration);
        Story {
            calibration: calibration.row.id,
            model: study.model_comparison().map(|comparison| comparison.text),
            missing: Missing::of(study, calibration),
            next: Next::of(study, calibration, wrong.is_within_noise()),
            wrong,
        }
    }

    /// The story of the study's current model; of the submitted job where no calibration has a posterior.
    pub fn current(study: &Study) -> Story {
        Story::of(study, study.current().unwrap_or(&study.lead))
    }
}
