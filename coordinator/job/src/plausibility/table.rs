//! Questions about a whole table: columns, wheels, radii and zeros, each judged by what all runs say together.

use shared::channel::Channel;
use shared::experiment::Experiment;

use super::contradiction::{Cause, Contradiction};
use super::question::{Question, sign_name};
use super::{exchanged, offset, radius, swapped};

/// Returns the questions about a table, given those about its values and signs.
///
/// A channel with another unit or sign contradicts the others too, so that only a swap is judged beside such a question: it may be its
/// cause.
pub(super) fn questions(experiment: &Experiment, earlier: &[Question]) -> Vec<Question> {
    let is_sound = !earlier.iter().any(|question| is_about_table(&question.name));
    let found = Contradiction::find(experiment);
    let found = found.filter(|found| is_sound || found.cause == Cause::SwappedColumns);
    let found = found.as_ref();
    let mut questions: Vec<Question> = swapped::question(experiment, found).into_iter().collect();
    if is_sound && questions.is_empty() {
        questions.extend(exchanged::question(experiment, found));
        questions.extend(radius::question(experiment, found));
        questions.extend(offset::questions(experiment, found));
    }
    questions
}

/// Returns whether a question is about a measured column, a load or a radius.
fn is_about_table(name: &str) -> bool {
    let of_channel = |channel: Channel| name == channel.column() || name == sign_name(channel);
    Channel::ALL.into_iter().any(of_channel) || ["wheel_load_n", "radius_m"].contains(&name)
}
