//! A job before it runs, as text.

use std::fmt::Write;

use job::{FreeParameter, JointPrior, Spec};
use shared::experiment::{AveragingProtocol, Experiment, MeasuredHistory, TestRun};

use super::campaign::campaign;
use super::column::width;
use super::table::Table;
use result::finished_calibration::prior_mean;
use result::words::number;

/// Largest number of recordings whose averages are all shown; of more the first one is.
const MAX_RECORDINGS: usize = 12;

/// Describes the data, model, algorithm and priors of a job.
pub fn specification(spec: &Spec) -> String {
    let mut text = spec
        .experiment
        .campaign
        .as_ref()
        .map(campaign)
        .unwrap_or_default();
    let holdout = spec.experiment.runs.len() - spec.fit_runs.len();
    let _ = writeln!(
        text,
        "{} with {}, {}; model {}; {}, seed {}",
        number::count(spec.fit_runs.len(), "fit run"),
        number::count(spec.wheel_data(), "measurement"),
        number::count(holdout, "holdout run"),
        spec.model_words(),
        spec.algorithm.words(),
        spec.algorithm.seed()
    );
    let bevameter = &spec.bevameter;
    for (readings, what) in [
        (bevameter.plates.len(), "plates"),
        (bevameter.rings.len(), "rings"),
    ] {
        if readings > 0 {
            let _ = writeln!(text, "{} of {what}", number::count(readings, "reading"));
        }
    }
    text += &averagings(&spec.experiment);
    let points = spec.transients.points();
    if points > 0 {
        let _ = writeln!(
            text,
            "{} of {} before they are steady, given their averages",
            number::count(points, "sinkage"),
            number::count(spec.transients.fitted.len(), "fitted run")
        );
    }
    for words in spec.joint_prior.iter().flat_map(JointPrior::words) {
        let _ = writeln!(text, "{words}");
    }
    for words in spec
        .likelihood_settings
        .words()
        .into_iter()
        .chain(spec.scatter_words())
    {
        let _ = writeln!(text, "{words}");
    }
    text.push('\n');
    let fixed = &spec.fit_variant.fixed;
    let width = width(spec.parameters.iter().map(|p| &p.name).chain(fixed.keys()));
    let free = Table::<&FreeParameter>::new()
        .left(width, "parameter", |p| &p.name)
        .right(12, "prior mean", |p| number::four_digits(prior_mean(&p.marginal)))
        .right(12, "prior sd", |p| number::four_digits(p.marginal.sd()))
        .right(12, "lower", |p| number::four_digits(p.marginal.support().0))
        .right(12, "upper", |p| number::four_digits(p.marginal.support().1))
        .apart(0, "unit", |p| &p.unit);
    text += &free.text(&spec.parameters);
    for (name, value) in fixed {
        let value = number::four_digits(*value);
        let _ = writeln!(text, "{name:<width$} {value:>12} {:>12}", "fixed");
    }
    text
}

/// Returns how the recordings were averaged: the first ones, and those that are not steady.
fn averagings(experiment: &Experiment) -> String {
    let recorded = experiment
        .runs
        .iter()
        .filter_map(|run| Some((run, run.history.as_ref()?)));
    let recorded: Vec<(&TestRun, &MeasuredHistory)> = recorded.collect();
    let first = match recorded.len() {
        count if count > MAX_RECORDINGS => 1,
        count => count,
    };
    let mut text = String::new();
    let mut not_steady = 0;
    for (position, (run, history)) in recorded.iter().enumerate() {
        if position < first {
            let _ = writeln!(text, "{}", averaging(&run.name, history, &experiment.protocol));
        } else if let Some(words) = unsteadiness(history) {
            not_steady += 1;
            let _ = writeln!(text, "run {}: {words}", run.name);
        }
    }
    if recorded.len() > first {
        let _ = writeln!(
            text,
            "{} averaged by the same protocol, {not_steady} of them not steady",
            number::count(recorded.len() - first, "further recording")
        );
    }
    text
}

/// Describes the part of a run's recording that is averaged: samples, periods.
fn averaging(run: &str, history: &MeasuredHistory, protocol: &AveragingProtocol) -> String {
    let filter = match protocol.lowpass_hz {
        0.0 => "not filtered".to_owned(),
        cutoff => format!("low-pass {cutoff} Hz"),
    };
    let (samples, step_s) = (history.t_s.len(), history.interval_s);
    let cut = (history.transient_s / step_s).round();
    let mut text = format!(
        "run {run}: {samples} samples of {step_s:.3} s in {}; {filter}, the first {cut:.0} ({} s) cut",
        history.file, history.transient_s
    );
    for (channel, recorded) in history.channels() {
        let over = match recorded.periods {
            0 => "all".to_owned(),
            1 => "1 grouser period of".to_owned(),
            periods => format!("{periods} grouser periods of"),
        };
        let _ = write!(
            text,
            "\n    {} {} over {over} the last {:.2} s",
            channel.column(),
            number::four_digits(recorded.average),
            recorded.covered_s
        );
    }
    if let Some(words) = unsteadiness(history) {
        let _ = write!(text, "\n    {words}");
    }
    text
}

/// Returns what makes a recording not steady; `None` if it is steady.
fn unsteadiness(history: &MeasuredHistory) -> Option<String> {
    let rate = history.relative_sinkage_rate.filter(|_| !history.is_steady())?;
    Some(format!(
        "not steady: the sinkage still changes by {:.1} % over one length of the contact; the run is held out",
        100.0 * rate
    ))
}
