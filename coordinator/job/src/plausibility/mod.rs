//! Questions about what a job and its experiment say: what is possible, but was probably not meant.
//!
//! # Layout
//! - `question`: [`Question`], and [`Unanswered`], the questions that a user must answer before anything is calibrated.
//! - `typed`: numbers outside the usual range of their quantity. `measured`: measurements and noise against each other, and against
//!   load and wheel. `sign`: channels with the opposite sign. `effects`: effects that act where they should not.
//!
//! The usual ranges stand in [`shared::limit`], which also refuses what no rig has. A question is answered by a correction, or by its
//! name under `accept` in the job.

mod effects;
mod measured;
pub(crate) mod question;
mod sign;
mod typed;

pub use question::{Question, Unanswered};

use crate::Spec;

/// Every question about a calibration, in the order of their names; answered or not.
///
/// Checked by `farm-tests mistakes::no_mistake_is_silent` and, for no question where none is due, by
/// `farm-tests mistakes::the_examples_raise_no_question`.
pub fn questions(spec: &Spec) -> Vec<Question> {
    let mut questions = typed::questions(spec);
    questions.extend(measured::questions(spec));
    questions.extend(sign::questions(&spec.experiment));
    questions.extend(effects::questions(spec));
    questions.sort_by(|a, b| a.name.cmp(&b.name));
    questions
}

/// Requires that every question is answered.
///
/// # Errors
/// [`Unanswered`], with all of them.
pub fn check_accepted(spec: &Spec) -> Result<(), Unanswered> {
    let mut open = questions(spec);
    open.retain(|question| !spec.accepted.contains(&question.name));
    match open.is_empty() {
        true => Ok(()),
        false => Err(Unanswered(open)),
    }
}
