//! The answer to "what next?": the steps of a study in order, with the command of each.

use std::collections::BTreeSet;

use record::{Discovery, Extension, NextRun, Verdict, effect_of, parts_of};
use shared::channel::Channel;

use super::added::AddedEffect;
use super::explanation::{run_words, split};
use super::statement::{Statement, statements};
use crate::story::missing::search_of;
use result::discovery::effect_file;
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::words::number;

/// File name in the command that exports the draws.
const POSTERIOR: &str = "posterior.csv";
/// What separates a test without a rolling wheel from the place of its result.
const RESULT: &str = ". Its result goes under ";
/// Maximum number of explanations that a step names; more are counted.
const EXPLANATIONS: usize = 4;

/// The next steps of a study, in order; at least one.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Next {
    /// Next steps, in the order of their benefit.
    pub steps: Vec<NextStep>,
    /// The first step in a sentence.
    pub text: String,
}

/// A next step.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct NextStep {
    /// Kind of the step.
    pub kind: StepKind,
    /// What to do, in a sentence without keys of files.
    pub text: String,
    /// Where the result is stated, with the keys of the files; null if nothing is stated.
    #[serde(default)]
    pub detail: Option<String>,
    /// Verb and arguments of the program `coordinator`, without the location of the study; null if no command does the step.
    pub command: Option<String>,
    /// The effect to add.
    pub effect: Option<String>,
    /// The only wheel with the effect.
    pub wheel: Option<String>,
    /// The effect file to add.
    pub effect_file: Option<EffectFile>,
    /// The runs to make.
    pub runs: Vec<NextRun>,
    /// The calibration that the runs are added to; null for a step without runs.
    pub calibration: Option<i64>,
}

/// Kind of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum StepKind {
    /// Add an effect of the catalogue.
    AddEffect,
    /// Add the effect of a file.
    AddEffectFile,
    /// Search for a missing effect.
    Discover,
    /// Widen a prior of the job.
    WidenPrior,
    /// Make test runs.
    MakeRuns,
    /// Make a test without a rolling wheel, or runs in conditions that no run had.
    MeasureOther,
    /// Add missing information to the experiment.
    StateInExperiment,
    /// Use the posterior.
    Predict,
}

/// An effect file.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct EffectFile {
    /// Name of the effect file.
    pub name: String,
    /// Text of the effect file.
    pub text: String,
}

impl NextStep {
    fn new(kind: StepKind, text: impl Into<String>, command: Option<String>) -> Self {
        NextStep {
            kind,
            text: text.into(),
            detail: None,
            command,
            effect: None,
            wheel: None,
            effect_file: None,
            runs: Vec::new(),
            calibration: None,
        }
    }
}

/// Facts other than the search that determine the next steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facts<'a> {
    /// Whether the noise explains the errors of every channel.
    pub(super) is_within_noise: bool,
    /// The effects that the study added to the model.
    pub(super) added: &'a [AddedEffect],
}

impl Next {
    pub(super) fn new(study: &Study, calibration: &FinishedCalibration, facts: Facts<'_>) -> Next {
        let steps = steps(study, calibration, facts);
        let text = steps.first().map_or_else(String::new, |step| step.text.clone());
        Next { steps, text }
    }
}

fn steps(study: &Study, calibration: &FinishedCalibration, facts: Facts<'_>) -> Vec<NextStep> {
    let id = calibration.row.id;
    if let Some(current) = study.current().filter(|current| current.row.id != id) {
        let text = format!(
            "go on with calibration {} ({}), the current model of the study",
            current.row.id, current.experiment
        );
        let command = format!("report {}", current.row.id);
        return vec![NextStep::new(StepKind::Predict, text, Some(command))];
    }
    let predict = |text: &str| {
        let command = format!("export {id} --output {POSTERIOR}");
        NextStep::new(StepKind::Predict, text, Some(command))
    };
    let deciding = facts.added.iter().filter_map(deciding);
    let Some(record) = search_of(study, calibration) else {
        let text = "search the library for the effect that the model is missing";
        let mut steps = vec![NextStep::new(
            StepKind::Discover,
            text,
            Some(format!("discover {id}")),
        )];
        if facts.is_within_noise {
            steps.push(predict(
                "predict with the posterior: its errors are within the noise",
            ));
        }
        steps.extend(deciding);
        return steps;
    };
    let add = record
        .extension
        .as_ref()
        .filter(|extension| !is_made(study, calibration, &parts_of(extension)))
        .map(|extension| addition(id, record, extension));
    let runs = (!record.next_runs.is_empty()).then(|| runs(id, &record.next_runs));
    let widen = record.implausible.as_ref().map(|parameter| {
        let text = format!(
            "widen the prior of {} in the job (one from a posterior by a larger transfer), and calibrate and search again",
            parameter.name
        );
        NextStep::new(StepKind::WidenPrior, text, None)
    });
    let mut steps: Vec<NextStep> = match record.verdict {
        // Runs come before an uncertain effect is added.
        Verdict::Undecided => widen
            .into_iter()
            .chain(noise(record))
            .chain(runs)
            .chain(add)
            .collect(),
        _ => add.into_iter().chain(runs).collect(),
    };
    if steps.is_empty() && facts.is_within_noise {
        steps.push(predict(
            "predict with the posterior: the model explains the runs to within the noise",
        ));
    }
    // Distinguishing an added effect from its rivals comes before all other steps.
    steps.splice(0..0, deciding);
    steps.extend(record.other_tests.iter().map(|test| bench_test(test)));
    // A statement takes no run.
    steps.extend(properties(record));
    steps.extend(runs_that_show(record));
    if steps.is_empty() {
        steps.push(predict(
            "predict with the posterior, within the errors above: these data show no more",
        ));
    }
    steps
}

/// Proposes a test without a rolling wheel: `make a tare run: …`, `measure the radius …`.
fn bench_test(test: &str) -> NextStep {
    let (what, place) = match test.split_once(RESULT) {
        Some((what, place)) => (what, Some(format!("its result goes under {place}"))),
        None => (test, None),
    };
    let is_quantity = what.starts_with("the ") || what.starts_with("radius");
    let verb = if is_quantity { "measure" } else { "make a" };
    NextStep {
        detail: place,
        ..NextStep::new(StepKind::MeasureOther, format!("{verb} {what}"), None)
    }
}

/// Proposes to measure the runs that would show effects, a step for each kind of run.
fn runs_that_show(record: &Discovery) -> Vec<NextStep> {
    let lacking = record.not_tried.iter().filter(|effect| effect.lacks_runs());
    let kinds: BTreeSet<&str> = lacking.map(|effect| effect.needs.as_str()).collect();
    let step = |needs: &str| {
        let of_kind = record.not_tried.iter().filter(|effect| effect.needs == needs);
        let (effects, names) = effects(of_kind.map(|effect| effect.name.as_str()));
        NextStep {
            detail: Some(format!("they would show {names}")),
            ..NextStep::new(
                StepKind::MeasureOther,
                format!("measure {needs}: they would show {effects}"),
                None,
            )
        }
    };
    kinds.into_iter().map(step).collect()
}

/// Proposes to state the properties that effects need, all in one step; `None` if there are none.
fn properties(record: &Discovery) -> Option<NextStep> {
    let lacking = record.not_tried.iter();
    let lacking: Vec<(&str, Vec<Statement>)> = lacking
        .map(|effect| (effect.name.as_str(), statements(&effect.needs)))
        .filter(|(_, statements)| !statements.is_empty())
        .collect();
    let all: BTreeSet<&Statement> = lacking.iter().flat_map(|(_, statements)| statements).collect();
    if all.is_empty() {
        return None;
    }
    let words: Vec<String> = all.iter().map(|statement| statement.words.clone()).collect();
    let places: Vec<&str> = all.iter().map(|statement| statement.place.as_str()).collect();
    let (effects, names) = effects(lacking.iter().map(|(name, _)| *name));
    Some(NextStep {
        detail: Some(format!(
            "in the experiment: {}; then the search judges {names}",
            places.join(", ")
        )),
        ..NextStep::new(
            StepKind::StateInExperiment,
            format!("state {}: the search then judges {effects}", number::list(&words)),
            None,
        )
    })
}

/// Counts effects, whatever wheel has them, and lists their names.
fn effects<'a>(names: impl Iterator<Item = &'a str>) -> (String, String) {
    let names: BTreeSet<String> = names.map(|name| split(name).0.to_owned()).collect();
    let names: Vec<String> = names.into_iter().collect();
    (number::count(names.len(), "further effect"), number::list(&names))
}

/// Proposes to state or measure the noise of channels whose inferred noise supports no claim; `None` if there are none.
fn noise(record: &Discovery) -> Option<NextStep> {
    let keys = record.unsupported_noise.iter();
    let keys: Vec<&str> = keys.map(|name| name.trim_start_matches("noise.")).collect();
    let words = |key: &&str| match Channel::ALL.iter().find(|channel| channel.column() == *key) {
        Some(channel) => channel.words().to_owned(),
        None => (*key).to_owned(),
    };
    (!keys.is_empty()).then(|| NextStep {
        detail: Some(format!("in the experiment: {} under [noise]", keys.join(", "))),
        ..NextStep::new(
            StepKind::StateInExperiment,
            format!(
                "state the noise (the sd of one measurement) of {}, or repeat at least three runs, and calibrate and search again",
                number::list(&keys.iter().map(words).collect::<Vec<String>>())
            ),
            None,
        )
    })
}

/// Returns whether the study already has a calibration of the same measurements whose model includes this one's parts and the added ones.
fn is_made(study: &Study, calibration: &FinishedCalibration, added: &[String]) -> bool {
    let parts = [study.parts(calibration).as_slice(), added].concat();
    let same = study
        .line()
        .filter(|other| other.row.experiment == calibration.row.experiment);
    let mut extended = same.map(|other| study.parts(other));
    extended.any(|other| parts.iter().all(|part| other.contains(part)))
}

/// Proposes the run that distinguishes an added effect from its rivals. The run is added to the model without the effect, which is then
/// searched again.
fn deciding(added: &AddedEffect) -> Option<NextStep> {
    let (run, searched) = (added.deciding_run.clone()?, added.searched?);
    let rivals = added.rivals.iter().map(|rival| rival.name.clone());
    let names: Vec<String> = std::iter::once(added.name.clone()).chain(rivals).collect();
    let text = format!(
        "run the wheel at {}, which tells {} apart, and add the row to calibration {searched}, which is then searched again",
        run_words(&run),
        number::list(&names)
    );
    Some(NextStep {
        runs: vec![run],
        calibration: Some(searched),
        ..NextStep::new(
            StepKind::MakeRuns,
            text,
            Some(format!("add-runs {searched} new-runs.csv")),
        )
    })
}

fn addition(id: i64, record: &Discovery, extension: &Extension) -> NextStep {
    let effect = effect_of(extension);
    let hedge = match record.verdict {
        Verdict::Undecided => "try",
        _ => "add",
    };
    match extension {
        Extension::Effect(_) => {
            let text = format!("{hedge} {effect} and calibrate again");
            let command = format!("extend {id} --effect {effect}");
            NextStep {
                effect: Some(effect),
                ..NextStep::new(StepKind::AddEffect, text, Some(command))
            }
        }
        Extension::OnWheel { wheel, .. } => {
            let text = format!("{hedge} {effect} on wheel {wheel} and calibrate again");
            let command = format!("extend {id} --effect {effect} --wheel {wheel}");
            NextStep {
                effect: Some(effect),
                wheel: Some(wheel.clone()),
                ..NextStep::new(StepKind::AddEffect, text, Some(command))
            }
        }
        Extension::File { name, text } => {
            let (name, text) = effect_file(record).unwrap_or_else(|| (name.clone(), text.clone()));
            let words = format!("{hedge} the law that was found, {effect}, and calibrate again");
            let command = format!("extend {id} --effect-file {name}");
            NextStep {
                effect: Some(effect),
                effect_file: Some(EffectFile { name, text }),
                ..NextStep::new(StepKind::AddEffectFile, words, Some(command))
            }
        }
    }
}

fn runs(id: i64, runs: &[NextRun]) -> NextStep {
    let mut separates: Vec<String> = runs.iter().flat_map(|run| run.separates.clone()).collect();
    separates.sort();
    separates.dedup();
    let words: Vec<String> = runs.iter().map(run_words).collect();
    let told_apart = match separates.len() {
        n if n > EXPLANATIONS => format!("the {n} open explanations"),
        _ => number::list(&separates),
    };
    let text = format!(
        "run the wheel at {}, which tells {told_apart} apart, and add the rows",
        words.join(", then ")
    );
    NextStep {
        runs: runs.to_vec(),
        calibration: Some(id),
        ..NextStep::new(
            StepKind::MakeRuns,
            text,
            Some(format!("add-runs {id} new-runs.csv")),
        )
    }
}

#[cfg(test)]
mod tests {
    use record::{ImplausibleParameter, NotTried};

    use super::*;
    use crate::fixture;

    /// Returns facts about a model whose errors exceed the noise.
    fn open() -> Facts<'static> {
        Facts {
            is_within_noise: false,
            added: &[],
        }
    }

    fn closed() -> Facts<'static> {
        Facts {
            is_within_noise: true,
            ..open()
        }
    }

    fn next(study: &Study, facts: Facts<'_>) -> Next {
        Next::new(study, &study.lead, facts)
    }

    fn kinds(next: &Next) -> Vec<StepKind> {
        next.steps.iter().map(|step| step.kind).collect()
    }

    /// Returns a searched study without the extension.
    fn searched() -> Study {
        let mut study = fixture::grown();
        study.extensions.clear();
        study
    }

    #[test]
    fn what_was_not_searched_is_searched_next() {
        let study = fixture::study();
        let next = next(&study, open());
        assert_eq!(kinds(&next), [StepKind::Discover]);
        assert_eq!(next.steps[0].command.as_deref(), Some("discover 1"));
        assert_eq!(kinds(&self::next(&study, closed()))[1], StepKind::Predict);
    }

    #[test]
    fn a_named_effect_is_added_before_runs_are_made_and_an_open_one_after() {
        let mut study = searched();
        let next = next(&study, open());
        assert_eq!(
            kinds(&next),
            [StepKind::AddEffect, StepKind::MakeRuns, StepKind::MeasureOther]
        );
        assert_eq!(
            next.steps[0].command.as_deref(),
            Some("extend 1 --effect slip_sinkage")
        );
        assert!(
            next.steps[1].text.contains("slip 0.60 under 80.0 N at 20.0 mm/s"),
            "{next:?}"
        );
        study.rounds[0].record.verdict = Verdict::Undecided;
        let open = self::next(&study, open());
        assert_eq!(kinds(&open)[..2], [StepKind::MakeRuns, StepKind::AddEffect]);
    }

    #[test]
    fn a_contradicted_prior_is_widened_before_runs_are_made() {
        let mut study = searched();
        let record = &mut study.rounds[0].record;
        record.verdict = Verdict::Undecided;
        record.extension = None;
        record.implausible = Some(ImplausibleParameter {
            name: "n".into(),
            prior_sds: -7.1,
        });
        let next = next(&study, open());
        assert_eq!(kinds(&next)[..2], [StepKind::WidenPrior, StepKind::MakeRuns]);
        assert!(next.text.starts_with("widen the prior of n"), "{}", next.text);
    }

    #[test]
    fn an_inferred_noise_that_supports_no_claim_is_stated_before_runs_are_made() {
        let mut study = searched();
        let record = &mut study.rounds[0].record;
        record.verdict = Verdict::Undecided;
        record.extension = None;
        record.unsupported_noise = vec!["noise.torque_n_m".into(), "noise.sinkage_m".into()];
        let next = next(&study, open());
        assert_eq!(
            kinds(&next)[..2],
            [StepKind::StateInExperiment, StepKind::MakeRuns]
        );
        assert!(
            next.text
                .starts_with("state the noise (the sd of one measurement) of torque and sinkage, or"),
            "{}",
            next.text
        );
    }

    #[test]
    fn an_extension_that_the_study_has_made_is_not_advised_again() {
        let mut study = fixture::grown();
        let advises = |study: &Study| kinds(&next(study, open())).contains(&StepKind::AddEffect);
        study.rounds[0].record.extension = Some(Extension::Effect("cohesion_pa".into()));
        assert!(advises(&study));
        study.extensions[0].spec.parameters[0].name = "cohesion_pa".into();
        assert_eq!(study.parts(&study.extensions[0]), ["cohesion_pa"]);
        assert!(!advises(&study));
        // With other measurements the extension has to be made again.
        study.lead.row.experiment += 1;
        assert!(advises(&study));
    }

    #[test]
    fn a_superseded_model_sends_to_the_current_one() {
        let mut study = fixture::grown();
        study.extensions[0].row.log_evidence = Some(10.0);
        let next = next(&study, open());
        assert_eq!(kinds(&next), [StepKind::Predict]);
        assert_eq!(next.steps[0].command.as_deref(), Some("report 3"));
    }

    #[test]
    fn a_law_that_was_found_is_added_by_its_file() {
        let mut study = searched();
        study.rounds[0].record.extension = Some(Extension::File {
            name: "anything.toml".into(),
            text: "name = \"shear_slip_step\"\n".into(),
        });
        let next = next(&study, open());
        assert_eq!(next.steps[0].kind, StepKind::AddEffectFile);
        let file = next.steps[0].effect_file.as_ref().unwrap();
        assert_eq!(file.name, "shear_slip_step.toml");
    }

    #[test]
    fn where_nothing_is_left_the_model_predicts_and_what_is_not_stated_is_asked_for() {
        let mut study = searched();
        let record = &mut study.rounds[0].record;
        record.verdict = Verdict::NothingDetectable;
        record.extension = None;
        record.next_runs.clear();
        record.other_tests.clear();
        record.not_tried = vec![NotTried {
            name: "end_wall".into(),
            why: "the length of the bin is not stated".into(),
            needs: "bin_length_m under [rig]".into(),
        }];
        let next = next(&study, closed());
        assert_eq!(kinds(&next), [StepKind::Predict, StepKind::StateInExperiment]);
        assert_eq!(
            next.steps[1].text,
            "state the length of the bin: the search then judges 1 further effect"
        );
        assert_eq!(
            next.steps[1].detail.as_deref(),
            Some("in the experiment: bin_length_m under [rig]; then the search judges end_wall")
        );
    }

    #[test]
    fn no_step_has_keys_of_files_in_its_sentence() {
        let mut study = searched();
        let record = &mut study.rounds[0].record;
        record.verdict = Verdict::Undecided;
        record.unsupported_noise = vec!["noise.torque_n_m".into()];
        record.other_tests = vec![
            "tare run: move the sled. Its result goes under [priors]: \"sled_tare.tare_n\" = { normal = [VALUE, SD] }"
                .into(),
        ];
        record.not_tried = ["density_kg_m3 under [soil.sand]", "bin_length_m under [rig]"]
            .map(|needs| NotTried {
                name: "end_wall".into(),
                why: "it is not stated".into(),
                needs: needs.into(),
            })
            .into();
        let next = next(&study, open());
        for step in &next.steps {
            assert!(!step.text.contains(['[', '=', '{']), "{step:?}");
        }
        let stated = next.steps.iter().filter(|step| step.detail.is_some());
        assert_eq!(stated.count(), 3, "{next:?}");
        assert_eq!(
            next.steps[next.steps.len() - 2].detail.as_deref(),
            Some("its result goes under [priors]: \"sled_tare.tare_n\" = { normal = [VALUE, SD] }")
        );
    }

    #[test]
    fn runs_that_an_effect_needs_are_measured_and_not_stated() {
        let mut study = searched();
        let record = &mut study.rounds[0].record;
        record.not_tried = vec![NotTried {
            name: "side_drag".into(),
            why: "it changes nothing at the slips and slip angles of the fitted runs".into(),
            needs: "runs at a slip angle".into(),
        }];
        let next = next(&study, closed());
        let step = next.steps.last().unwrap();
        assert_eq!(
            (step.kind, step.text.as_str()),
            (
                StepKind::MeasureOther,
                "measure runs at a slip angle: they would show 1 further effect"
            )
        );
    }
}
