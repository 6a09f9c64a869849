//! The story of a calibration in three sentences: what its model gets wrong, what is missing, what to do next.
//!
//! # Layout
//! - `wrong`: the errors, worst first. `pattern`: the conditions at which they are largest.
//! - `missing`: the verdict of the search; `added`: effects that the study added before. `explanation`: explanations in words.
//! - `next`: the next steps with their commands; `statement`: what an experiment lacks. `rig`: what the rig did, for a study.

mod added;
mod explanation;
mod missing;
mod next;
mod pattern;
mod rig;
mod statement;
pub(crate) mod wrong;

use next::Facts;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;

pub(crate) use added::added;
pub use added::{AddedEffect, Strength};
pub use explanation::Alternative;
pub(crate) use missing::short_verdict;
pub use missing::{Missing, NamedEffect};
pub use next::{EffectFile, Next, NextStep, StepKind};
pub use rig::rig_sentences;
pub use wrong::{BesideInterpolation, ChannelFailure, Wrong};

/// The story of a calibration within its study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Story {
    /// Id of the calibration.
    pub calibration: i64,
    /// A sentence on the comparison of the job's models; null if the job has one model.
    pub model: Option<String>,
    /// What the calibration's model gets wrong.
    pub wrong: Wrong,
    /// The effect that is missing, with its probability.
    pub missing: Missing,
    /// What to do next.
    pub next: Next,
}

impl Story {
    /// Describes a calibration of the study.
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

    /// Describes the study's current model, or the submitted job if no calibration has a posterior.
    pub fn current(study: &Study) -> Story {
        Story::new(study, study.current().unwrap_or(&study.lead))
    }
}
