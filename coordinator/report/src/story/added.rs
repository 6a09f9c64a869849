//! The effects that the study added to a model, with the verdicts of the searches and the improvement of the error.

use job::FreeParameter;
use record::{Discovery, NOT_IN_LIBRARY, NextRun, Verdict, addition_name, effect_of};

use super::explanation::{Alternative, law_places, open, p, parts, run_words, summary};
use result::discovery::DiscoveryRound;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::words::number;

/// A larger error on unseen runs, in noise standard deviations, casts doubt on the names of the added effects.
const MAX_HELD_OUT_ERROR: f64 = 1.3;

/// An effect that the study added.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct AddedEffect {
    /// Name of the effect, as the search calls it if one judged it.
    pub name: String,
    /// What the effect does, in a few words; null for a law outside the catalogue.
    pub summary: Option<String>,
    /// Its parameters in the calibration, in the order of the job.
    pub strengths: Vec<Strength>,
    /// Whether the verdict of a search names it. Another effect was added by hand, or for the sake of predictions.
    pub is_named: bool,
    /// Probability that a search gave it; null if no search named it or left it open.
    pub probability: Option<f64>,
    /// The calibration that was searched.
    pub searched: Option<i64>,
    /// Other explanations that this search could not exclude, by decreasing probability; empty if it named the effect.
    pub rivals: Vec<Alternative>,
    /// The run that best distinguishes it from its rivals; null without rivals, or if the search found no run.
    pub deciding_run: Option<NextRun>,
    /// The effect of the searched model in whose place the search named it; null if it was named beside the model's effects.
    pub in_place_of: Option<String>,
    /// Holdout error before and after, in the noise standard deviations of the study; null without a holdout measurement, or if the study
    /// has no model that differs in this effect only.
    pub held_out_noise_sds: Option<[f64; 2]>,
}

/// A parameter of an effect in a calibration.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Strength {
    /// Name of the parameter.
    pub name: String,
    /// SI unit of the parameter.
    pub unit: String,
    /// Posterior mean \[SI\].
    pub mean: f64,
    /// Posterior standard deviation \[SI\].
    pub sd: f64,
}

impl AddedEffect {
    /// Describes the effect: `slip_sinkage was missing (P 0.96) and is added: held-out error from 2.1 to 0.9 times the noise`.
    pub(super) fn words(&self) -> String {
        let mut text = self.short();
        if let Some(replaced) = &self.in_place_of {
            text += &format!(" in the place of {replaced}");
        }
        if let Some([before, after]) = self.held_out_noise_sds {
            let [before, after] = [before, after].map(|sds| number::significant(sds, 2));
            text += &match before == after {
                true => format!(": held-out error unchanged, {after} times the noise"),
                false => format!(": held-out error from {before} to {after} times the noise"),
            };
        }
        match self.open_question() {
            Some(question) => format!("{text}; {question}"),
            None => text,
        }
    }

    /// Describes the effect in a few words: `slip_sinkage was missing (P 0.96) and is added`.
    pub(super) fn short(&self) -> String {
        let name = &self.name;
        match self.probability {
            Some(probability) if self.is_told() => {
                format!("{name} was missing ({}) and is added", p(probability))
            }
            Some(probability) => format!("{name} ({}) is added", p(probability)),
            None => format!("{name} was added by hand"),
        }
    }

    /// Returns whether a search names it and leaves nothing open.
    fn is_told(&self) -> bool {
        self.is_named && self.rivals.is_empty()
    }

    /// Describes the rival explanations: `slip_softened_pressure (P 0.32) in place of slip_sinkage cannot be excluded; slip 0.60 under
    /// 80.0 N at 20.0 mm/s would tell`; `None` without rivals.
    pub(crate) fn open_question(&self) -> Option<String> {
        let rivals: Vec<String> = self.rivals.iter().map(Alternative::words).collect();
        let run = self.deciding_run.as_ref();
        let run = run.map(|run| format!("; {} would tell", run_words(run)));
        (!rivals.is_empty()).then(|| {
            format!(
                "{} in place of {} cannot be excluded{}",
                number::list(&rivals),
                self.name,
                run.unwrap_or_default()
            )
        })
    }
}

/// Lists the effects that the study added to the model of a calibration: those of searches in the order of the searches, then the others,
/// each in the order of the model.
pub(crate) fn added(study: &Study, calibration: &FinishedCalibration) -> Vec<AddedEffect> {
    let had = study.lead.effects();
    let has = study.parts(calibration);
    let mut left: Vec<String> = has.iter().filter(|part| !had.contains(part)).cloned().collect();
    let order = left.clone();
    let mut found = Vec::new();
    // Take the newest search first, because further runs may have decided what an earlier one left open.
    for round in study.rounds.iter().rev() {
        let mut calibrations = study.calibrations();
        let Some(before) = calibrations.find(|c| c.row.id == round.calibration) else {
            continue;
        };
        let is_ancestor = kept(study, round, before).iter().all(|part| has.contains(part));
        while let Some(judged) = judged(&round.record, &left).filter(|_| is_ancestor) {
            let effect_parts = parts(&judged.name);
            left.retain(|part| !effect_parts.contains(part));
            let effect = AddedEffect {
                strengths: strengths(calibration, &effect_parts),
                ..of_search(study, round, before, &judged, &has)
            };
            found.push((position(&order, &effect_parts), effect));
        }
    }
    let by_hand = left.into_iter().map(|name| {
        let effect_parts = [name.clone()];
        let effect = AddedEffect {
            summary: summary(&name),
            strengths: strengths(calibration, &effect_parts),
            held_out_noise_sds: held_out_errors(study, calibration, &effect_parts),
            name,
            is_named: false,
            probability: None,
            searched: None,
            rivals: Vec::new(),
            deciding_run: None,
            in_place_of: None,
        };
        (position(&order, &effect_parts), effect)
    });
    found.extend(by_hand);
    found.sort_by_key(|(position, effect)| (effect.searched.unwrap_or(i64::MAX), *position));
    found.into_iter().map(|(_, effect)| effect).collect()
}

/// Lists the parameters of the given parts of a calibration's model.
fn strengths(calibration: &FinishedCalibration, parts: &[String]) -> Vec<Strength> {
    let summaries = calibration.parameter_summaries();
    let is_of = |name: &str| {
        let mut parts = parts.iter();
        parts.any(|part| {
            name == part
                || name
                    .strip_prefix(part.as_str())
                    .is_some_and(|rest| rest.starts_with('.'))
        })
    };
    let parameters = calibration
        .spec
        .parameters
        .iter()
        .filter(|parameter| is_of(&parameter.name));
    let strength = |parameter: &FreeParameter| {
        let (_, summary) = summaries.iter().find(|(name, _)| *name == parameter.name)?;
        Some(Strength {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            mean: summary.mean,
            sd: summary.sd,
        })
    };
    parameters.filter_map(strength).collect()
}

fn position(order: &[String], parts: &[String]) -> usize {
    let place = order.iter().position(|part| parts.contains(part));
    place.unwrap_or(order.len())
}

/// Returns the explanation that a search names or leaves open and whose parts are all in `left`; of several, the one with the most parts.
fn judged(record: &Discovery, left: &[String]) -> Option<Alternative> {
    let named = record.extension.as_ref().map(|extension| {
        let name = addition_name(extension);
        let of_search = record.effects.iter().find(|e| e.name == name);
        let outside = || record.effects.iter().find(|e| e.name == NOT_IN_LIBRARY);
        let replacement = record.named_replacement().map(|named| named.probability);
        let of_model = of_search.or_else(outside).map(|e| e.probability);
        // The name of an effect on one wheel includes the wheel. The name of a law outside the library is in its file.
        let name = if of_search.is_some() {
            name
        } else {
            effect_of(extension)
        };
        let place = law_places(record, &name).into_iter().next();
        let place = place
            .filter(|_| of_search.is_none())
            .map(|place| place.probability);
        let probability = replacement.or(place).or(of_model).unwrap_or(0.0);
        Alternative {
            summary: summary(&name),
            name,
            probability,
        }
    });
    let leading = record.leading.as_ref().map(addition_name);
    let leading = leading.and_then(|name| record.effects.iter().find(|e| e.name == name));
    let is_there = |explanation: &Alternative| {
        let parts = parts(&explanation.name);
        !parts.is_empty() && parts.iter().all(|part| left.contains(part))
    };
    let explanations = named
        .into_iter()
        .chain(open(record).into_iter().map(Alternative::from))
        .chain(leading.map(Alternative::from));
    let there: Vec<Alternative> = explanations.filter(is_there).collect();
    let size = |explanation: &Alternative| parts(&explanation.name).len();
    let largest = there.iter().map(size).max()?;
    there.into_iter().find(|explanation| size(explanation) == largest)
}

fn of_search(
    study: &Study,
    round: &DiscoveryRound,
    before: &FinishedCalibration,
    judged: &Alternative,
    has: &[String],
) -> AddedEffect {
    let effect_parts = parts(&judged.name);
    let is_rival = |rival: &Alternative| {
        let parts = parts(&rival.name);
        parts != effect_parts && !parts.iter().all(|part| has.contains(part))
    };
    let rivals: Vec<Alternative> = open(&round.record)
        .into_iter()
        .map(Alternative::from)
        .chain(law_places(&round.record, &judged.name))
        .filter(is_rival)
        .collect();
    let extended = [kept(study, round, before), effect_parts].concat();
    let replacement = round.record.named_replacement();
    let replacement = replacement.filter(|named| named.effect == judged.name);
    AddedEffect {
        in_place_of: replacement.map(|named| named.in_place_of.clone()),
        summary: judged.summary.clone(),
        strengths: Vec::new(),
        name: judged.name.clone(),
        is_named: matches!(round.record.verdict, Verdict::Named | Verdict::NotInLibrary),
        probability: Some(judged.probability),
        searched: Some(round.calibration),
        deciding_run: round
            .record
            .next_runs
            .first()
            .filter(|_| !rivals.is_empty())
            .cloned(),
        rivals,
        held_out_noise_sds: errors(study, before, &extended),
    }
}

/// Lists the parts of a searched model without the effect that the search replaces.
fn kept(study: &Study, round: &DiscoveryRound, searched: &FinishedCalibration) -> Vec<String> {
    let replaced = round.record.named_replacement().map(|named| &named.in_place_of);
    let parts = study.parts(searched).into_iter();
    parts.filter(|part| Some(part) != replaced).collect()
}

/// Returns the holdout errors without and with the given parts of a model; `None` if the study has no model without them.
fn held_out_errors(study: &Study, calibration: &FinishedCalibration, added: &[String]) -> Option<[f64; 2]> {
    let has = study.parts(calibration);
    let rest: Vec<String> = has.iter().filter(|part| !added.contains(part)).cloned().collect();
    errors(study, alike(study, calibration, &rest)?, &has)
}

/// Returns the calibration in the ledger with the same measurements whose model has exactly these parts.
fn alike<'a>(
    study: &'a Study,
    measured: &FinishedCalibration,
    parts: &[String],
) -> Option<&'a FinishedCalibration> {
    study.ledger().find(|line| {
        let of_line = study.parts(line);
        let is_same = of_line.len() == parts.len() && parts.iter().all(|part| of_line.contains(part));
        is_same && line.row.experiment == measured.row.experiment
    })
}

/// Returns the holdout errors of a calibration, and of the one with the same measurements and these parts.
fn errors(study: &Study, before: &FinishedCalibration, parts: &[String]) -> Option<[f64; 2]> {
    let after = alike(study, before, parts)?;
    let ((before_lacks, before), (after_lacks, after)) = (held_out(study, before)?, held_out(study, after)?);
    // Errors of models that refuse different runs are not comparable.
    (before_lacks == after_lacks).then_some([before, after])
}

/// Returns the number of holdout measurements without a prediction, and the error of the others in the noise standard deviations of the
/// study.
fn held_out(study: &Study, calibration: &FinishedCalibration) -> Option<(usize, f64)> {
    let table = calibration.comparison().holdout.clone()?;
    let table = table.in_fixed_sigmas(&study.fixed_sigmas());
    Some((table.all.unpredicted, table.all.rmse_fixed_sigma?))
}

/// Returns a caution where searches named what a model has, and the model predicts unseen runs clearly worse than the noise.
///
/// The error was larger than 1.3 noise standard deviations in 2 of 66 models that were complete and right, and in 16 of 23 models with
/// a wrong name.
pub(super) fn unseen_runs(
    study: &Study,
    calibration: &FinishedCalibration,
    added: &[AddedEffect],
) -> Option<String> {
    let is_named = added.iter().any(AddedEffect::is_told);
    let (_, error) = held_out(study, calibration).filter(|_| is_named)?;
    (error > MAX_HELD_OUT_ERROR).then(|| {
        format!(
            "named, but the error on unseen runs is {} times the noise",
            number::significant(error, 2)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overview::overview;
    use crate::story::Story;
    use crate::{document, fixture, terminal};

    const RIVAL: &str = "slip_softened_pressure (P 0.30) in place of slip_sinkage cannot be excluded";
    const RUN: &str = "slip 0.60 under 80.0 N at 20.0 mm/s";

    #[test]
    fn a_member_of_a_class_keeps_its_rivals_and_the_run_that_decides_wherever_the_verdict_is_told() {
        let study = fixture::of_a_class();
        let story = Story::current(&study);
        assert_eq!(story.calibration, 3);
        let missing = &story.missing;
        let added = &missing.already_added[0];
        assert_eq!((added.probability, added.searched), (Some(0.68), Some(1)));
        for words in [
            "slip_sinkage (P 0.68) is added",
            RIVAL,
            RUN,
            "beyond that, nothing",
        ] {
            assert!(missing.text.contains(words), "{words} in {}", missing.text);
        }
        let first = &story.next.steps[0];
        assert_eq!(first.command.as_deref(), Some("add-runs 1 new-runs.csv"));
        assert_eq!((first.runs.len(), first.calibration), (1, Some(1)));
        assert!(first.text.contains(RUN), "{first:?}");
        let verdict = overview(&study).verdict.unwrap();
        assert_eq!(verdict.calibration, 3);
        assert!(
            verdict.text.contains(RIVAL) && verdict.text.contains(RUN),
            "{verdict:?}"
        );
        let home = overview(&study).list_item(None).verdict.unwrap().open.unwrap();
        assert!(home.starts_with(RIVAL) && home.contains(RUN), "{home}");
        let printed = terminal::story(&story, std::path::Path::new("out/sand"), terminal::WIDTH);
        let printed = printed.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(printed.contains(RIVAL) && printed.contains(RUN), "{printed}");
        assert!(document::document(&study, &document::ReportPredictions::default()).contains(RIVAL));
    }

    #[test]
    fn a_law_whose_place_these_data_do_not_tell_keeps_the_other_places_as_rivals() {
        let mut study = fixture::of_a_class();
        let record = &mut study.rounds[0].record;
        record.verdict = record::Verdict::NotInLibrary;
        // The law has the name of the effect that the study added.
        record.extension = Some(record::Extension::File {
            name: "slip_sinkage.toml".into(),
            text: "name = \"slip_sinkage\"\n".into(),
        });
        record.effects.truncate(1);
        record.effects[0].name = NOT_IN_LIBRARY.into();
        record.effects[0].probability = 0.98;
        let place = |depends_on: &str, probability| record::LawPlace {
            acts_on: "pressure".into(),
            depends_on: depends_on.into(),
            probability,
        };
        record.outside = Some(record::Outside {
            acts_on: "pressure".into(),
            depends_on: "slip".into(),
            places: vec![place("v_t", 0.6), place("slip", 0.4)],
            form: "power".into(),
            log_bayes_factor: 30.0,
            effect_file: String::new(),
            curve: Vec::new(),
            left_out_nats: [20.0; 2],
            forms: Vec::new(),
            formulas: None,
        });
        let story = Story::current(&study);
        let text = &story.missing.text;
        for words in [
            "slip_sinkage (P 0.39) is added",
            "pressure_v_t (P 0.59) in place of slip_sinkage cannot be excluded",
            RUN,
        ] {
            assert!(text.contains(words), "{words} in {text}");
        }
    }

    #[test]
    fn a_rival_that_is_added_too_is_none_and_a_newer_search_that_names_one_settles_it() {
        let mut study = fixture::of_a_class();
        let mut named = study.rounds[0].clone();
        named.record.verdict = record::Verdict::Named;
        named.record.extension = Some(record::Extension::Effect("slip_sinkage".into()));
        study.rounds.push(named);
        let story = Story::current(&study);
        assert!(story.missing.already_added[0].rivals.is_empty());
        assert!(
            story
                .missing
                .text
                .starts_with("slip_sinkage was missing (P 0.68) and is added")
        );
        assert_eq!(overview(&study).verdict.unwrap().open, None);
    }

    #[test]
    fn an_effect_on_the_nodes_that_a_search_named_was_not_added_by_hand() {
        let study = fixture::on_the_nodes();
        let extension = &study.extensions[0];
        assert_eq!(study.parts(extension), ["janosi_hanamoto", "displacement_node"]);
        let added = added(&study, extension);
        assert_eq!(added.len(), 1, "{added:?}");
        assert_eq!(
            (added[0].name.as_str(), added[0].probability),
            ("janosi_hanamoto_node", Some(0.96))
        );
        let text = Story::new(&study, extension).missing.text;
        assert!(
            text.starts_with("janosi_hanamoto_node was missing (P 0.96) and is added"),
            "{text}"
        );
        assert!(!text.contains("by hand"), "{text}");
        // The next steps do not advise to add it again.
        let next = Story::new(&study, &study.lead).next;
        assert!(next.steps.iter().all(|step| step.effect.is_none()), "{next:?}");
    }

    #[test]
    fn what_an_effect_bought_on_held_out_runs_stands_beside_it() {
        let mut study = fixture::of_a_class();
        for prediction in &mut study.lead.predictions {
            if let Some(Ok(held)) = prediction.holdout.as_mut().map(|holdout| &mut holdout.together) {
                held.drawbar_pull_n.iter_mut().for_each(|pull| *pull += 5.0);
            }
        }
        let [before, after] = added(&study, &study.extensions[0])[0].held_out_noise_sds.unwrap();
        let error = |calibration: &FinishedCalibration| {
            let table = calibration.comparison().holdout.clone().unwrap();
            table
                .in_fixed_sigmas(&study.fixed_sigmas())
                .all
                .rmse_fixed_sigma
                .unwrap()
        };
        assert!(before > after);
        assert!((before - error(&study.lead)).abs() < 1e-12);
        assert!((after - error(&study.extensions[0])).abs() < 1e-12);
        let words = format!("held-out error from {} to", number::significant(before, 2));
        let text = Story::current(&study).missing.text;
        assert!(text.contains(&words), "{text}");
        let mut effect = added(&study, &study.extensions[0]).remove(0);
        effect.held_out_noise_sds = Some([38.2, 37.7]);
        let text = effect.words();
        assert!(
            text.contains(": held-out error unchanged, 38 times the noise"),
            "{text}"
        );
    }
}
