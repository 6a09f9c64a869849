//! The story of a calibration in three sentences: what its model gets wrong, what is missing, what to do next.
//!
//! # Layout
//! - `wrong`: the errors, worst first. `pattern`: where they are.
//! - `missing`: the searches' answer; `added`: what the study added before. `explanation`: the explanations of a search in words.
//! - `next`: steps with their commands.

mod added;
mod explanation;
mod missing;
mod next;
mod pattern;
mod wrong;

use next::Facts;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;

pub use added::AddedEffect;
pub(crate) use added::added;
pub use explanation::Alternative;
pub use missing::{Missing, NamedEffect};
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
    pub fn new(study: &Study, calibration: &FinishedCalibration) -> Story {
        let wrong = Wrong::new(study, calibration);
        let missing = Missing::new(study, calibration);
        let facts = Facts {
            is_within_noise: wrong.is_within_noise(),
            added: &missing.already_added,
        };
        Story {
            calibration: calibration.row.id,
            model: study.model_comparison().map(|comparison| comparison.text),
            next: Next::new(study, calibration, facts),
            missing,
            wrong,
        }
    }

    /// The story of the study's current model; of the submitted job where no calibration has a posterior.
    pub fn current(study: &Study) -> Story {
        Story::new(study, study.current().unwrap_or(&study.lead))
    }
}
