//! Why repeats cannot tell offsets of sessions, tarings or operators, in a sentence.

use inference::diagnostics::NoGroupOffsets;
use job::{levels_of, load_levels_of};
use shared::experiment::{RigColumn, TestRun};

use super::compared_runs::ComparedRuns;
use crate::words::number::list;

/// A setting of the rig: its name, its value in a run, and the levels of values.
type Setting = (&'static str, fn(&TestRun) -> f64, fn(&[f64]) -> Vec<usize>);

/// The settings that may differ between sessions.
const SETTINGS: [Setting; 5] = [
    ("slip", |run| run.slip, levels_of),
    ("wheel load", |run| run.wheel_load_n, load_levels_of),
    ("sled speed", |run| run.sled_speed_m_s, levels_of),
    ("slip angle", |run| run.slip_angle_deg, levels_of),
    ("pass", |run| f64::from(run.pass), levels_of),
];

/// Returns the consequence of a reason, and what to repeat; `None` if repeats are equal, as nominal loads are: nothing is measured.
pub(super) fn sentence(
    compared: &ComparedRuns<'_>,
    column: RigColumn,
    reason: NoGroupOffsets,
) -> Option<String> {
    let RigWords {
        one,
        with_article,
        several,
        preposition,
    } = RigWords::new(column);
    let wheel = match compared.wheel {
        Some(wheel) => format!("wheel {wheel}"),
        None => "the wheels".to_owned(),
    };
    Some(match reason {
        NoGroupOffsets::GroupsFollowConditions => {
            let settings = list(&followed(compared));
            let (shared, effect) = match settings.is_empty() {
                true => (
                    "have no condition in common".to_owned(),
                    "the conditions".to_owned(),
                ),
                false => (format!("follow the {settings}"), format!("the {settings}")),
            };
            let example = match &compared.ids[..] {
                [first, second, ..] => format!(", for example conditions of {first} {preposition} {second}"),
                _ => String::new(),
            };
            format!(
                "the {several} of {wheel} {shared}: an offset of {with_article} cannot be told from an effect of {effect}; repeat conditions of {with_article} {preposition} another{example}"
            )
        }
        NoGroupOffsets::FewRepeats => format!(
            "{wheel} has fewer than three repeats of conditions: offsets of {several} cannot be told from effects of the conditions; repeat conditions, some {preposition} the same {one} and some {preposition} another"
        ),
        NoGroupOffsets::NoRepeatWithinGroup => format!(
            "the repeats of {wheel} do not tell an offset of {with_article} from the scatter of a run; repeat conditions {preposition} the same {one}"
        ),
        NoGroupOffsets::EqualRepeats => return None,
    })
}

/// The words for the ids of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RigWords {
    /// One id: `session`.
    pub one: &'static str,
    /// One id with its article: `a session`.
    pub with_article: &'static str,
    /// Several ids: `sessions`.
    pub several: &'static str,
    /// The preposition of runs: `in` a session, `with` an operator.
    pub preposition: &'static str,
}

impl RigWords {
    /// Returns the words of a column.
    pub fn new(column: RigColumn) -> Self {
        let (one, with_article, several, preposition) = match column {
            RigColumn::Session => ("session", "a session", "sessions", "in"),
            RigColumn::Zero => ("taring", "a taring", "tarings", "with"),
            RigColumn::Operator => ("operator", "an operator", "operators", "with"),
        };
        RigWords {
            one,
            with_article,
            several,
            preposition,
        }
    }
}

/// Returns the settings of which no level occurs with two ids.
fn followed(compared: &ComparedRuns<'_>) -> Vec<String> {
    let is_followed = |(_, value, levels_of): &&Setting| {
        let values: Vec<f64> = compared.runs.iter().map(|run| value(run)).collect();
        let levels = levels_of(&values);
        let meet = |i: usize, j: usize| levels[i] == levels[j] && compared.groups[i] != compared.groups[j];
        !(0..levels.len()).any(|i| (0..i).any(|j| meet(i, j)))
    };
    let followed = SETTINGS.iter().filter(is_followed);
    followed.map(|(name, ..)| (*name).to_owned()).collect()
}
