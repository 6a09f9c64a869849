//! A plausibility question, its name, and the check of its answer.

use std::collections::BTreeSet;

use shared::channel::Channel;
use shared::file::unknown_word;
use shared::limit::LIMITS;
use shared::parameters::noise_parameter;

/// The question of a calibration with fewer fitted data than parameters.
pub(super) const DATA_FEW: &str = "data_few";
/// The question of an effect's neutral value.
pub(super) const NEUTRAL: &str = "neutral";
/// The question of slip angles.
pub(super) const SLIP_ANGLE: &str = "slip_angle_deg";

/// The question of columns that seem swapped.
pub(super) const SWAPPED_COLUMNS: &str = "swapped_columns";
/// The question of wheels that seem exchanged.
pub(super) const EXCHANGED_WHEELS: &str = "exchanged_wheels";
/// The question of a radius that seems a diameter.
pub(super) const RADIUS_OR_DIAMETER: &str = "radius_or_diameter";
/// The question of the zero of pull or torque.
pub(super) const FORCE_ZERO: &str = "force_zero";
/// The question of the zero of the sinkage.
pub(super) const SINKAGE_ZERO: &str = "sinkage_zero";
/// The questions about a whole table.
const TABLE_QUESTIONS: [&str; 5] = [
    SWAPPED_COLUMNS,
    EXCHANGED_WHEELS,
    RADIUS_OR_DIAMETER,
    FORCE_ZERO,
    SINKAGE_ZERO,
];

/// Returns the name of the question about the sign of a channel.
pub(super) fn sign_name(channel: Channel) -> String {
    format!("{}_sign", channel.name())
}

/// A value that is possible but probably unintended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    /// The name under `accept`; it names the value in question.
    pub name: String,
    /// A sentence about the odd value, with place, value, unit and bound.
    pub words: String,
}

impl Question {
    pub(super) fn new(name: impl Into<String>, words: String) -> Question {
        let name = name.into();
        Question { name, words }
    }

    /// Returns the names of all questions.
    pub fn names() -> BTreeSet<String> {
        let limited = LIMITS.iter().map(|limit| limit.name.to_owned());
        let measured = Channel::ALL.map(|channel| channel.column().to_owned());
        limited
            .chain(Channel::ALL.map(noise_parameter))
            .chain(measured)
            .chain(Channel::ALL.map(sign_name))
            .chain([DATA_FEW, NEUTRAL, SLIP_ANGLE].map(str::to_owned))
            .chain(TABLE_QUESTIONS.map(str::to_owned))
            .collect()
    }

    /// Checks that there is a question of this name.
    ///
    /// # Errors
    /// The sentence with the nearest name.
    pub(crate) fn check_name(name: &str) -> Result<(), String> {
        let known = Question::names();
        match known.contains(name) {
            true => Ok(()),
            false => {
                let known = known.iter().map(String::as_str);
                Err(unknown_word("name under accept", name, known))
            }
        }
    }
}

/// The questions without an answer, at least one.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}; correct this, or accept it as meant: {}", self.words(), self.how())]
pub struct Unanswered(pub Vec<Question>);

impl Unanswered {
    fn words(&self) -> String {
        let each = self.0.iter().map(|question| question.words.as_str());
        each.collect::<Vec<_>>().join("; ")
    }

    fn how(&self) -> String {
        let names = || self.0.iter().map(|question| question.name.as_str());
        let flags: Vec<String> = names().map(|name| format!("--accept {name}")).collect();
        let list: Vec<String> = names().map(|name| format!("\"{name}\"")).collect();
        format!(
            "{}, or accept = [{}] in the job",
            flags.join(" "),
            list.join(", ")
        )
    }
}
