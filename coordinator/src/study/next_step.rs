//! The next step of a study. It depends on the state of the study alone, so that a restart takes the same step.

use std::collections::{BTreeMap, BTreeSet};

use shared::api::CalibrationState;

use job::{Apply, DiscoverySettings};
use record::{CalibrationRow, Change, Discovery, Extension, parts_of};

use super::lineage::{Lineage, is_part};

/// The results of the finished calibrations of a study, by their ids.
#[derive(Debug, Clone, Default)]
pub struct StudyFindings {
    /// The calibrations that have a posterior: the lines of the error ledger.
    pub ledger: BTreeSet<i64>,
    /// The records of the searches.
    pub searches: BTreeMap<i64, Discovery>,
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

/// Returns the index of the model with the largest evidence, the first of equal ones; `None` without any.
pub fn most_probable(log_evidences: impl Iterator<Item = Option<f64>>) -> Option<usize> {
    let finite = log_evidences.enumerate().filter_map(|(i, log)| Some((i, log?)));
    let best = finite.reduce(|best, next| if next.1 > best.1 { next } else { best })?;
    Some(best.0)
}

/// Returns the next step of a study; `None` if it is complete or a member is unfinished.
///
/// A failed or cancelled member ends it. With `ask` the last calibration of the ledger is searched, and the user decides. With `auto` it is
/// extended by the effect that its search names, up to the allowed number of effects beyond those of the first member; an effect that was
/// dropped is neither added nor dropped again. With `leading` the study adds the leading candidate of a search that names none, too. Where
/// a search names an effect in the place of one that the study added, that one is dropped
/// and the other is then added, without a search between them. If the job compares several models, the study continues with the model of largest evidence.
///
/// # Arguments
/// - `rows`: the members of the study.
/// - `withdrawn`: what was taken out of it. The study goes on as without it, whatever its state, but an effect that was taken back is not
///   added again, and one whose dropping was taken back is not dropped again.
pub fn next_step(
    settings: DiscoverySettings,
    rows: &[CalibrationRow],
    withdrawn: &[CalibrationRow],
    findings: &StudyFindings,
) -> Option<StudyStep> {
    if settings.apply == Apply::Off || rows.iter().any(|row| row.state != CalibrationState::Finished) {
        return None;
    }
    let lineage = Lineage::new(rows);
    let compared = lineage.compared();
    let later = &rows[compared.len()..];
    let first = match compared {
        [] => return None,
        [only] => only,
        _ => &compared[most_probable(compared.iter().map(|row| row.log_evidence))?],
    };
    let last = std::iter::once(first)
        .chain(later)
        .rfind(|row| findings.ledger.contains(&row.id))?;
    let Some(search) = lineage.search_of(last.id) else {
        let replacing = replacing(lineage, findings, last)
            .filter(|extension| settings.apply != Apply::Ask && !is_taken_back(withdrawn, extension));
        return Some(match replacing {
            Some(extension) => StudyStep::Extend(last.id, extension),
            None => StudyStep::Search(last.id),
        });
    };
    if settings.apply == Apply::Ask {
        return None;
    }
    let record = findings.searches.get(&search.id)?;
    // Effects of the submitted job are the user's choice.
    let was_dropped =
        |effect: &str| lineage.has_dropped(effect) || Lineage::new(withdrawn).has_dropped(effect);
    let can_go = |effect: &&String| lineage.has_added(last.id, effect) && !was_dropped(effect);
    let leading = record
        .leading
        .as_ref()
        .filter(|_| settings.apply == Apply::Leading);
    if let Some(extension) = record.extension.as_ref().or(leading) {
        let parts = parts_of(extension);
        let is_refused = parts.iter().any(|part| was_dropped(part)) || is_taken_back(withdrawn, extension);
        let is_there = parts.iter().all(|part| lineage.has_added(last.id, part));
        let replaced = record.named_replacement().map(|named| &named.in_place_of);
        if let Some(effect) = replaced.filter(can_go).filter(|_| !is_refused && !is_there) {
            return Some(StudyStep::Drop(last.id, vec![effect.clone()]));
        }
        if lineage.additions(last.id).len() < settings.max_effects && !is_refused && !is_there {
            return Some(StudyStep::Extend(last.id, extension.clone()));
        }
    }
    let drop: Vec<String> = record.drop.iter().filter(can_go).cloned().collect();
    (!drop.is_empty()).then_some(StudyStep::Drop(last.id, drop))
}

/// Returns whether a part of an extension was itself taken back. What was taken out with something that it followed from may be added
/// again.
fn is_taken_back(withdrawn: &[CalibrationRow], extension: &Extension) -> bool {
    let parts = parts_of(extension);
    let follows = |row: &CalibrationRow| {
        withdrawn
            .iter()
            .any(|other| Some(other.id) == row.membership.parent)
    };
    withdrawn.iter().any(|row| match &row.membership.change {
        Some(Change::Add(added)) => !follows(row) && parts.iter().any(|part| is_part(added, part)),
        _ => false,
    })
}

/// Returns the effect that a search named in the place of one that this calibration was made without.
fn replacing(lineage: Lineage, findings: &StudyFindings, last: &CalibrationRow) -> Option<Extension> {
    let Some(Change::Drop(dropped)) = &last.membership.change else {
        return None;
    };
    let search = lineage.search_of(last.membership.parent?)?;
    let record = findings.searches.get(&search.id)?;
    let replaced = &record.named_replacement()?.in_place_of;
    let extension = record.extension.clone().filter(|_| dropped.contains(replaced))?;
    let is_tried = lineage
        .existing(last.id, &Change::Add(extension.clone()))
        .is_some();
    (!is_tried).then_some(extension)
}

#[cfg(test)]
mod tests {
    use record::{JudgedReplacement, Membership, Role, effect_of};

    use super::*;

    fn base(id: i64) -> CalibrationRow {
        CalibrationRow::finished(id, Membership::submitted(Role::Sample))
    }

    fn added(id: i64, parent: i64, effect: &str) -> CalibrationRow {
        let change = Change::Add(Extension::Effect(effect.to_owned()));
        CalibrationRow::finished(id, Membership::changed(Role::Sample, parent, change))
    }

    fn dropped(id: i64, parent: i64, effect: &str) -> CalibrationRow {
        let change = Change::Drop(vec![effect.to_owned()]);
        CalibrationRow::finished(id, Membership::changed(Role::Sample, parent, change))
    }

    fn fit(id: i64) -> CalibrationRow {
        CalibrationRow::finished(
            id,
            Membership::changed(Role::Fit, 1, Change::Algorithm("ga".into())),
        )
    }

    fn search(id: i64, parent: i64) -> CalibrationRow {
        CalibrationRow::finished(id, Membership::search_of(parent))
    }

    fn found() -> Discovery {
        serde_json::from_str(include_str!("../../record/discovery.json")).unwrap()
    }

    fn names(effect: Option<&str>, drop: &[&str]) -> Discovery {
        Discovery {
            extension: effect.map(|name| Extension::Effect(name.to_owned())),
            drop: drop.iter().map(|&e| e.to_owned()).collect(),
            ..found()
        }
    }

    /// Returns the next step with at most two effects, where searches found these.
    fn step(apply: Apply, rows: &[CalibrationRow], records: &[(i64, Discovery)]) -> Option<StudyStep> {
        step_without(&[], apply, rows, records)
    }

    /// Returns the same of a study from which some calibrations were taken back.
    fn step_without(
        withdrawn: &[CalibrationRow],
        apply: Apply,
        rows: &[CalibrationRow],
        records: &[(i64, Discovery)],
    ) -> Option<StudyStep> {
        let settings = DiscoverySettings {
            apply,
            max_effects: 2,
            other_kind: false,
        };
        let samples = rows.iter().filter(|row| row.membership.role == Role::Sample);
        let findings = StudyFindings {
            ledger: samples.map(|row| row.id).collect(),
            searches: records.iter().cloned().collect(),
        };
        next_step(settings, rows, withdrawn, &findings)
    }

    fn extend(id: i64, effect: &str) -> Option<StudyStep> {
        Some(StudyStep::Extend(id, Extension::Effect(effect.to_owned())))
    }

    #[test]
    fn of_several_models_the_one_with_the_most_evidence_is_searched_and_extended() {
        let model = |id: i64, log_evidence| CalibrationRow {
            log_evidence: Some(log_evidence),
            ..match id {
                1 => base(1),
                _ => CalibrationRow::finished(
                    id,
                    Membership::changed(Role::Sample, 1, Change::Model(id as usize - 1)),
                ),
            }
        };
        let mut rows = vec![model(1, -30.0), model(2, -20.0), model(3, -20.0)];
        assert_eq!(step(Apply::Auto, &rows, &[]), Some(StudyStep::Search(2)));
        rows.push(search(4, 2));
        let mut records = vec![(4, names(Some("a"), &[]))];
        assert_eq!(step(Apply::Auto, &rows, &records), extend(2, "a"));
        rows.push(added(5, 2, "a"));
        assert_eq!(step(Apply::Auto, &rows, &records), Some(StudyStep::Search(5)));
        rows.push(search(6, 5));
        records.push((6, names(None, &[])));
        assert_eq!(step(Apply::Auto, &rows, &records), None);
        assert_eq!(most_probable([None, None].into_iter()), None);
        let one = [base(1)];
        assert_eq!(
            step(Apply::Auto, &one, &[]),
            Some(StudyStep::Search(1)),
            "evidence is not needed"
        );
    }

    #[test]
    fn nothing_is_looked_for_unless_the_job_says_so() {
        let rows = [base(1), fit(2)];
        assert_eq!(step(Apply::Off, &rows, &[]), None);
        assert_eq!(step(Apply::Ask, &rows, &[]), Some(StudyStep::Search(1)));
        assert_eq!(step(Apply::Auto, &rows, &[]), Some(StudyStep::Search(1)));
    }

    #[test]
    fn a_member_that_is_not_finished_is_waited_for_and_one_that_failed_ends_the_growth() {
        for &state in CalibrationState::ALL {
            let rows = [base(1), CalibrationRow { state, ..fit(2) }];
            let expected = (state == CalibrationState::Finished).then_some(StudyStep::Search(1));
            assert_eq!(step(Apply::Auto, &rows, &[]), expected, "{state:?}");
        }
    }

    #[test]
    fn ask_searches_once_and_leaves_the_rest_to_the_user() {
        let records = [(2, names(Some("lug_thrust"), &[]))];
        let mut rows = vec![base(1), search(2, 1)];
        assert_eq!(step(Apply::Ask, &rows, &records), None);
        rows.push(added(3, 1, "lug_thrust"));
        assert_eq!(step(Apply::Ask, &rows, &records), Some(StudyStep::Search(3)));
    }

    #[test]
    fn auto_adds_what_is_named_until_the_allowed_number_is_there() {
        let mut rows = vec![base(1), search(2, 1)];
        let mut records = vec![(2, names(Some("a"), &[]))];
        assert_eq!(step(Apply::Auto, &rows, &records), extend(1, "a"));
        rows.push(added(3, 1, "a"));
        assert_eq!(step(Apply::Auto, &rows, &records), Some(StudyStep::Search(3)));
        rows.push(search(4, 3));
        records.push((4, names(None, &[])));
        assert_eq!(step(Apply::Auto, &rows, &records), None);
        records[1] = (4, names(Some("b"), &[]));
        assert_eq!(step(Apply::Auto, &rows, &records), extend(3, "b"));
        rows.extend([added(5, 3, "b"), search(6, 5)]);
        records.push((6, names(Some("c"), &[])));
        assert_eq!(step(Apply::Auto, &rows, &records), None, "two are added");
    }

    #[test]
    fn an_effect_is_dropped_once_and_does_not_come_back() {
        let mut rows = vec![
            base(1),
            search(2, 1),
            added(3, 1, "a"),
            search(4, 3),
            added(5, 3, "b"),
        ];
        rows.push(search(6, 5));
        let mut records = vec![
            (2, names(Some("a"), &[])),
            (4, names(Some("b"), &[])),
            (6, names(None, &["a", "of_the_job"])),
        ];
        assert_eq!(
            step(Apply::Auto, &rows, &records),
            Some(StudyStep::Drop(5, vec!["a".into()]))
        );
        rows.extend([dropped(7, 5, "a"), search(8, 7)]);
        records.push((8, names(Some("a"), &[])));
        assert_eq!(step(Apply::Auto, &rows, &records), None, "it was dropped before");
        // the user adds it nevertheless
        rows.extend([added(9, 7, "a"), search(10, 9)]);
        records.push((10, names(None, &["a"])));
        assert_eq!(
            step(Apply::Auto, &rows, &records),
            None,
            "and is not dropped twice"
        );
    }

    #[test]
    fn a_study_for_predictions_adds_the_leading_candidate_of_an_open_search() {
        let open = |leading: &str| Discovery {
            leading: Some(Extension::Effect(leading.to_owned())),
            ..names(None, &[])
        };
        let mut rows = vec![base(1), search(2, 1)];
        let mut records = vec![(2, open("a"))];
        assert_eq!(step(Apply::Auto, &rows, &records), None);
        assert_eq!(step(Apply::Ask, &rows, &records), None);
        assert_eq!(step(Apply::Leading, &rows, &records), extend(1, "a"));
        rows.extend([added(3, 1, "a"), search(4, 3)]);
        // What a search names comes before what leads, and what the model has is not added again.
        records.push((
            4,
            Discovery {
                extension: Some(Extension::Effect("b".into())),
                ..open("c")
            },
        ));
        assert_eq!(step(Apply::Leading, &rows, &records), extend(3, "b"));
        records[1] = (4, open("a"));
        assert_eq!(step(Apply::Leading, &rows, &records), None);
        records[1] = (4, names(None, &[]));
        assert_eq!(step(Apply::Leading, &rows, &records), None);
    }

    #[test]
    fn an_effect_takes_the_place_of_one_that_the_study_added() {
        let in_place_of = |effect: &str| Discovery {
            replacements: vec![JudgedReplacement {
                effect: "b".into(),
                in_place_of: effect.into(),
                log_bayes_factor: 9.0,
                probability: 0.99,
                is_named: true,
            }],
            ..names(Some("b"), &["a"])
        };
        let mut rows = vec![base(1), search(2, 1), added(3, 1, "a"), search(4, 3)];
        let mut records = vec![(2, names(Some("a"), &[])), (4, in_place_of("a"))];
        let drop = Some(StudyStep::Drop(3, vec!["a".into()]));
        assert_eq!(step(Apply::Auto, &rows, &records), drop);
        assert_eq!(step(Apply::Ask, &rows, &records), None);
        let of_job = [records[0].clone(), (4, in_place_of("of_the_job"))];
        assert_eq!(step(Apply::Auto, &rows, &of_job), extend(3, "b"));
        rows.push(dropped(5, 3, "a"));
        assert_eq!(step(Apply::Auto, &rows, &records), extend(5, "b"));
        assert_eq!(step(Apply::Ask, &rows, &records), Some(StudyStep::Search(5)));
        rows.push(added(6, 5, "b"));
        assert_eq!(step(Apply::Auto, &rows, &records), Some(StudyStep::Search(6)));
        rows.push(search(7, 6));
        records.push((7, names(Some("a"), &[])));
        assert_eq!(step(Apply::Auto, &rows, &records), None, "it was replaced");
    }

    #[test]
    fn what_was_taken_back_neither_stops_the_study_nor_is_extended_or_added_again() {
        let records = [(2, names(Some("a"), &[])), (6, names(Some("b"), &[]))];
        for state in [CalibrationState::Cancelled, CalibrationState::Finished] {
            let withdrawn = [
                CalibrationRow {
                    state,
                    ..added(3, 1, "a")
                },
                CalibrationRow {
                    state,
                    ..search(4, 3)
                },
            ];
            let step = |rows: &[CalibrationRow]| step_without(&withdrawn, Apply::Auto, rows, &records);
            let mut rows = vec![base(1)];
            assert_eq!(step(&rows), Some(StudyStep::Search(1)), "{state:?}");
            rows.push(search(2, 1));
            assert_eq!(
                step(&rows),
                None,
                "{state:?}: the search names what was taken back"
            );
            let runs = Membership::changed(Role::Sample, 1, Change::Runs(3));
            rows.push(CalibrationRow::finished(5, runs));
            assert_eq!(step(&rows), Some(StudyStep::Search(5)), "{state:?}");
            rows.push(search(6, 5));
            assert_eq!(step(&rows), extend(5, "b"), "{state:?}");
        }
    }

    #[test]
    fn what_followed_from_runs_that_were_taken_back_is_added_again() {
        let runs =
            |id: i64| CalibrationRow::finished(id, Membership::changed(Role::Sample, 1, Change::Runs(3)));
        let withdrawn = [runs(3), search(4, 3), added(5, 3, "a")];
        let rows = [base(1), search(2, 1), runs(6), search(7, 6)];
        let records = [(2, names(None, &[])), (7, names(Some("a"), &[]))];
        assert_eq!(
            step_without(&withdrawn, Apply::Auto, &rows, &records),
            extend(6, "a")
        );
    }

    #[test]
    fn an_effect_whose_dropping_was_taken_back_is_not_dropped_again() {
        let rows = [base(1), search(2, 1), added(3, 1, "a"), search(4, 3)];
        let records = [(2, names(Some("a"), &[])), (4, names(None, &["a"]))];
        let drop = Some(StudyStep::Drop(3, vec!["a".into()]));
        assert_eq!(step(Apply::Auto, &rows, &records), drop);
        let withdrawn = [dropped(5, 3, "a")];
        assert_eq!(step_without(&withdrawn, Apply::Auto, &rows, &records), None);
    }

    #[test]
    fn an_effect_on_the_nodes_is_known_again_by_its_effect_and_its_setting() {
        let node = "janosi_hanamoto_node";
        let mut rows = vec![base(1), search(2, 1)];
        let mut records = vec![(2, names(Some(node), &[]))];
        assert_eq!(step(Apply::Auto, &rows, &records), extend(1, node));
        rows.extend([added(3, 1, node), search(4, 3)]);
        records.push((4, names(Some(node), &[])));
        assert_eq!(step(Apply::Auto, &rows, &records), None, "the model has it");
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
