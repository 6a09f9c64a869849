//! Questions about values of a job and its experiment that are possible but probably unintended.
//!
//! # Layout
//! - `question`: [`Question`], and [`Unanswered`], the questions that a user must answer before anything is calibrated.
//! - `unusual`: numbers outside the usual range of their quantity. `comparison`: values that do not fit other values. `sign`: channels
//!   with the opposite sign. `effects`: effects that change the model at their neutral values.
//! - `table`: mistakes of a whole table, which a search would explain by physics: `swapped` columns, `exchanged` wheels, `radius` for
//!   diameter, `offset` of a channel. `moment_balance`, `contradiction`: the evidence that needs no model of the soil. `like_runs`: runs
//!   that can be compared.
//!
//! [`shared::limit`] states the usual ranges, and the physical limits beyond which a value is refused. A user answers a question by
//! correcting the value, or by listing the question's name under `accept` in the job.

mod comparison;
mod contradiction;
mod effects;
mod exchanged;
mod like_runs;
mod moment_balance;
mod offset;
pub(crate) mod question;
mod radius;
mod sign;
mod swapped;
mod table;
mod unusual;

pub use question::{Question, Unanswered};

use crate::Spec;

/// Returns every question about a calibration, answered or not, in the order of their names.
///
/// Checked by `farm-tests bad_input::gallery::no_mistake_of_a_user_is_silent` and, for no question where none is due, by
/// `farm-tests mistakes::the_examples_raise_no_question`.
pub fn questions(spec: &Spec) -> Vec<Question> {
    let mut questions = unusual::questions(spec);
    questions.extend(comparison::questions(spec));
    questions.extend(sign::questions(&spec.experiment));
    questions.extend(table::questions(&spec.experiment, &questions));
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
