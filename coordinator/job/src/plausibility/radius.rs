//! Diameters in place of radii.

use shared::experiment::Experiment;
use shared::limit::number;

use super::contradiction::{Cause, Contradiction};
use super::question::{Question, RADIUS_OR_DIAMETER};

/// Returns the question about a radius that fits torque, pull, load and sinkage only if it is halved or doubled.
///
/// Checked by `farm-tests mistaken_tables::every_mistake_of_a_table_is_asked_about`.
pub(super) fn question(experiment: &Experiment, found: Option<&Contradiction>) -> Option<Question> {
    let found = found?;
    let Cause::Radius { wheels, factor } = &found.cause else {
        return None;
    };
    let (multiple, hint) = match *factor < 1.0 {
        true => ("half", "was a diameter typed?"),
        false => ("twice", "was the radius halved, as a diameter would be?"),
    };
    let stated = wheels.iter().map(|name| {
        let radius_m = experiment.wheels[name].radius_m;
        format!(
            "wheel {name} has {multiple} its radius_m of {} m",
            number(radius_m)
        )
    });
    let stated: Vec<String> = stated.collect();
    let words = format!("{} {}: {hint}", found.words(), stated.join(" and "));
    Some(Question::new(RADIUS_OR_DIAMETER, words))
}
