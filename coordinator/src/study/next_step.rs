//! The next step of a study, a function of its state alone: a restart takes the same step.

use std::collections::BTreeSet;

use shared::api::CalibrationState;

use job::{Apply, DiscoverySettings};
use record::parts_of;
use record::{Discovery, Extension};

/// A calibration of a study.
#[derive(Debug, Clone)]
pub struct StudyMember {
    /// Its id.
    pub id: i64,
    /// Its state.
    pub state: CalibrationState,
    /// Its role in the study.
    pub part: StudyRole,
}

/// The role of a calibration in its study.
#[derive(Debug, Clone)]
pub enum StudyRole {
    /// A line of the error ledger.
    Ledger {
        /// Names of its model's effects.
        effects: Vec<String>,
        /// The search of its model, if there is one.
        search: Option<i64>,
        /// Its log-evidence, once it is finished.
        log_evidence: Option<f64>,
    },
    /// A point estimate.
    Beside,
    /// A search for a missing effect, with its record once it is finished.
    Search(Option<Box<Discovery>>),
}

/// The next addition to a study.
#[derive(Debug, Clone, PartialEq)]
pub enum StudyStep {
    /// The search of a calibration's model.
    Search(i64),
    /// A calibration extended by the effect that its search names.
    Extend(i64, Extension),
    /// A calibration without effects that no longer improve its evidence.
    Drop(i64, Vec<String>),
}

/// Which of several models has the most evidence, the first of equals; `None` without any.
pub fn most_probable(log_evidences: impl Iterator<Item = Option<f64>>) -> Option<usize> {
    let known = log_evidences.enumerate().filter_map(|(i, log)| Some((i, log?)));
    let best = known.reduce(|best, own| if own.1 > best.1 { own } else { best })?;
    Some(best.0)
}

/// The next step of a study; `None` where it is complete or a member is unfinished.
///
/// A failed or cancelled member ends it. With `ask` the last calibration of the ledger is searched, and the user decides. With
/// `auto` it is extended by the effect that its search names, up to the allowed number of effects beyond those of the first
/// member; an effect that was dropped is neither added nor dropped again. Where the first `models` members are models to compare, the
/// study goes on with the one of most evidence.
pub fn next_step(settings: DiscoverySettings, models: usize, members: &[StudyMember]) -> Option<StudyStep> {
    if settings.apply == Apply::Off || members.iter().any(|m| m.state != CalibrationState::Finished) {
        return None;
    }
    let (compared, later) = members.split_at_checked(models)?;
    let best = most_probable(compared.iter().map(|member| match &member.part {
        StudyRole::Ledger { log_evidence, .. } => *log_evidence,
        StudyRole::Beside | StudyRole::Search(_) => None,
    }));
    let first = match models {
        1 => &compared[0],
        _ => &compared[best?],
    };
    let ledger: Vec<(i64, BTreeSet<&str>, Option<i64>)> = std::iter::once(first)
        .chain(later)
        .filter_map(|member| match &member.part {
            StudyRole::Ledger { effects, search, .. } => {
                Some((member.id, effects.iter().map(String::as_str).collect(), *search))
            }
            StudyRole::Beside | StudyRole::Search(_) => None,
        })
        .collect();
    let (last, has, search) = ledger.last()?;
    let Some(search) = search else {
        return Some(StudyStep::Search(*last));
    };
    if settings.apply == Apply::Ask {
        return None;
    }
    let found = members.iter().find_map(|member| match &member.part {
        StudyRole::Search(record) if member.id == *search => record.as_deref(),
        _ => None,
    })?;
    let dropped: BTreeSet<&str> = ledger
        .windows(2)
        .flat_map(|pair| pair[0].1.difference(&pair[1].1))
        .copied()
        .collect();
    let added = has.difference(&ledger[0].1).count();
    if let Some(extension) = &found.extension {
        let parts = parts_of(extension);
        let is_dropped = parts.iter().any(|part| dropped.contains(part.as_str()));
        let is_there = parts.iter().all(|part| has.contains(part.as_str()));
        if added < settings.max_effects && !is_dropped && !is_there {
            return Some(StudyStep::Extend(*last, extension.clone()));
        }
    }
    let drop: Vec<String> = found
        .drop
        .iter()
        .filter(|effect| {
            let effect = effect.as_str();
            // Effects of the first job are the user's choice.
            has.contains(effect) && !ledger[0].1.contains(effect) && !dropped.contains(effect)
        })
        .cloned()
        .collect();
    (!drop.is_empty()).then_some(StudyStep::Drop(*last, drop))
}

#[cfg(test)]
mod tests {
    use record::effect_of;

    use super::*;

    fn ledger(id: i64, effects: &[&str], search: Option<i64>) -> StudyMember {
        StudyMember {
            id,
            state: CalibrationState::Finished,
            part: StudyRole::Ledger {
                effects: effects.iter().map(|&e| e.to_owned()).collect(),
                search,
                log_evidence: None,
            },
        }
    }

    fn search(id: i64, names: Option<&str>, drop: &[&str]) -> StudyMember {
        let record = Discovery {
            extension: names.map(|name| Extension::Effect(name.to_owned())),
            drop: drop.iter().map(|&e| e.to_owned()).collect(),
            ..found()
        };
        StudyMember {
            id,
            state: CalibrationState::Finished,
            part: StudyRole::Search(Some(Box::new(record))),
        }
    }

    fn found() -> Discovery {
        serde_json::from_str(include_str!("../../record/discovery.json")).unwrap()
    }

    fn beside(id: i64) -> StudyMember {
        StudyMember {
            id,
            state: CalibrationState::Finished,
            part: StudyRole::Beside,
        }
    }

    fn step(apply: Apply, members: &[StudyMember]) -> Option<StudyStep> {
        let settings = DiscoverySettings {
            apply,
            max_effects: 2,
            other_kind: false,
        };
        next_step(settings, 1, members)
    }

    fn extend(id: i64, effect: &str) -> Option<StudyStep> {
        Some(StudyStep::Extend(id, Extension::Effect(effect.to_owned())))
    }

    #[test]
    fn of_several_models_the_one_with_the_most_evidence_is_searched_and_extended() {
        let model = |id, log: f64, search| {
            let StudyMember { state, part, .. } = ledger(id, &[], search);
            let StudyRole::Ledger { effects, search, .. } = part else {
                unreachable!("a line of the ledger")
            };
            let log_evidence = Some(log);
            let part = StudyRole::Ledger {
                effects,
                search,
                log_evidence,
            };
            StudyMember { id, state, part }
        };
        let settings = DiscoverySettings {
            apply: Apply::Auto,
            max_effects: 2,
            other_kind: false,
        };
        let mut members = vec![
            model(1, -30.0, None),
            model(2, -20.0, None),
            model(3, -20.0, None),
        ];
        assert_eq!(next_step(settings, 3, &members), Some(StudyStep::Search(2)));
        members[1] = model(2, -20.0, Some(4));
        members.push(search(4, Some("a"), &[]));
        assert_eq!(next_step(settings, 3, &members), extend(2, "a"));
        members.push(ledger(5, &["a"], None));
        assert_eq!(next_step(settings, 3, &members), Some(StudyStep::Search(5)));
        assert_eq!(most_probable([None, None].into_iter()), None);
        assert_eq!(next_step(settings, 9, &members), None, "not all are there");
    }

    #[test]
    fn nothing_is_looked_for_unless_the_job_says_so() {
        let members = [ledger(1, &[], None), beside(2)];
        assert_eq!(step(Apply::Off, &members), None);
        assert_eq!(step(Apply::Ask, &members), Some(StudyStep::Search(1)));
        assert_eq!(step(Apply::Auto, &members), Some(StudyStep::Search(1)));
    }

    #[test]
    fn a_member_that_is_not_finished_is_waited_for_and_one_that_failed_ends_the_growth() {
        for state in CalibrationState::ALL {
            let members = [ledger(1, &[], None), StudyMember { state, ..beside(2) }];
            let expected = (state == CalibrationState::Finished).then_some(StudyStep::Search(1));
            assert_eq!(step(Apply::Auto, &members), expected, "{state:?}");
        }
    }

    #[test]
    fn ask_searches_once_and_leaves_the_rest_to_the_user() {
        let base = [ledger(1, &[], Some(2)), search(2, Some("lug_thrust"), &[])];
        assert_eq!(step(Apply::Ask, &base), None);
        let extended = [base.to_vec(), vec![ledger(3, &["lug_thrust"], None)]].concat();
        assert_eq!(step(Apply::Ask, &extended), Some(StudyStep::Search(3)));
    }

    #[test]
    fn auto_adds_what_is_named_until_nothing_is() {
        let mut members = vec![ledger(1, &["hard_pan"], Some(2)), search(2, Some("a"), &[])];
        assert_eq!(step(Apply::Auto, &members), extend(1, "a"));
        members.push(ledger(3, &["hard_pan", "a"], None));
        assert_eq!(step(Apply::Auto, &members), Some(StudyStep::Search(3)));
        members.pop();
        members.extend([ledger(3, &["hard_pan", "a"], Some(4)), search(4, None, &[])]);
        assert_eq!(step(Apply::Auto, &members), None);
        members.pop();
        members.push(search(4, Some("b"), &[]));
        assert_eq!(step(Apply::Auto, &members), extend(3, "b"));
        members.extend([
            ledger(5, &["hard_pan", "a", "b"], Some(6)),
            search(6, Some("c"), &[]),
        ]);
        assert_eq!(
            step(Apply::Auto, &members),
            None,
            "two are added, the job's own does not count"
        );
    }

    #[test]
    fn an_effect_is_dropped_once_and_does_not_come_back() {
        let mut members = vec![
            ledger(1, &[], Some(2)),
            search(2, Some("a"), &[]),
            ledger(3, &["a"], Some(4)),
            search(4, Some("b"), &[]),
            ledger(5, &["a", "b"], Some(6)),
            search(6, None, &["a"]),
        ];
        assert_eq!(
            step(Apply::Auto, &members),
            Some(StudyStep::Drop(5, vec!["a".into()]))
        );
        members.extend([ledger(7, &["b"], Some(8)), search(8, Some("a"), &[])]);
        assert_eq!(step(Apply::Auto, &members), None, "it was dropped before");
        // the user insists
        members.extend([ledger(9, &["a", "b"], Some(10)), search(10, None, &["a"])]);
        assert_eq!(step(Apply::Auto, &members), None, "and is not dropped twice");
    }

    #[test]
    fn an_effect_on_the_nodes_is_known_again_by_its_effect_and_its_setting() {
        let named = Some("janosi_hanamoto_node");
        let has = ["displacement_node", "janosi_hanamoto"];
        let mut members = vec![ledger(1, &[], Some(2)), search(2, named, &[])];
        assert_eq!(step(Apply::Auto, &members), extend(1, "janosi_hanamoto_node"));
        members.extend([ledger(3, &has, Some(4)), search(4, named, &[])]);
        assert_eq!(step(Apply::Auto, &members), None, "the model has it");
    }

    #[test]
    fn a_file_s_effect_has_the_name_that_stands_in_it() {
        let file = |text: &str| Extension::File {
            name: "mine.toml".into(),
            text: text.into(),
        };
        assert_eq!(
            effect_of(&file("name = \"shear_slip_step\"\n")),
            "shear_slip_step"
        );
        assert_eq!(effect_of(&file("nothing")), "mine.toml");
    }
}
