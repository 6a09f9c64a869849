//! Tables for a terminal.

use std::fmt::Write;

use formula::Variable;
use shared::api::CalibrationStatus;
use shared::channel::Channel;
use shared::experiment::{AveragingProtocol, MeasuredHistory};
use shared::model::{EffectSet, ModelKind};

use super::comparison::{Comparison, ComparisonRow};
use super::coverage::Coverage;
use super::diagnostics::terminal::{findings, flags};
use super::errors::ErrorTable;
use super::point_estimate::fitted;
use super::readings::{error_model, reading_errors};
use super::settling::unsettled;
use super::{FinishedCalibration, Study, prior_mean};
use job::{FreeParameter, JointPrior, Spec};
use record::EstimateRow;

/// What a reader of the result should know of the model before it runs.
pub fn notes(spec: &Spec) -> Vec<String> {
    let mut notes = Vec::new();
    let lugged: Vec<&str> = spec
        .experiment
        .wheels
        .iter()
        .filter(|(_, wheel)| wheel.has_grousers())
        .map(|(name, _)| name.as_str())
        .collect();
    let lugged = lugged.join(", ");
    // what was read once is read again
    let effects = EffectSet::read(&spec.fit_variant.effects).unwrap_or_default();
    let named = |variables: &[Variable]| variables.iter().any(|v| effects.using(*v).is_some());
    match spec.fit_variant.kind {
        ModelKind::QuasiStatic => {
            if !lugged.is_empty() && !named(&[Variable::GrouserCount, Variable::GrouserHeight]) {
                notes.push(format!(
                    "quasi_static models the smooth rim: the grousers of {lugged} enter only through a radius of their own (wheel_radius_m.NAME)"
                ));
            }
            if spec.experiment.runs.iter().any(|r| r.pass > 1) && !named(&[Variable::Pass]) {
                notes.push(
                    "quasi_static has no memory between passes: every pass is predicted like the first".into(),
                );
            }
        }
        ModelKind::Scm if lugged.is_empty() => {}
        ModelKind::Scm => notes.push(format!(
            "scm rolls the grousers of {lugged}, but a height field cannot show their flanks: thrust beyond their sheared tips is left out"
        )),
    }
    notes
}

/// What a job means, before it runs.
pub fn specification(spec: &Spec) -> String {
    let mut text = String::new();
    let holdout = spec.experiment.runs.len() - spec.fit_runs.len();
    let _ = writeln!(
        text,
        "{} fit runs with {} measurements, {holdout} holdout runs; model {}; {}, seed {}",
        spec.fit_runs.len(),
        spec.wheel_data(),
        spec.model_words(),
        spec.method.words(),
        spec.method.seed()
    );
    let bevameter = &spec.bevameter;
    for (readings, what) in [
        (bevameter.plates.len(), "plates"),
        (bevameter.rings.len(), "rings"),
    ] {
        if readings > 0 {
            let _ = writeln!(text, "{readings} readings of {what}");
        }
    }
    for run in &spec.experiment.runs {
        if let Some(history) = &run.history {
            let _ = writeln!(
                text,
                "{}",
                averaging(&run.name, history, &spec.experiment.protocol)
            );
        }
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
    let _ = writeln!(
        text,
        "{:<width$} {:>12} {:>12} {:>12} {:>12}  unit",
        "parameter", "prior mean", "prior sd", "lower", "upper"
    );
    for p in &spec.parameters {
        let (lower, upper) = p.marginal.support();
        let _ = writeln!(
            text,
            "{:<width$} {:>12} {:>12} {:>12} {:>12}  {}",
            p.name,
            number(prior_mean(&p.marginal)),
            number(p.marginal.sd()),
            number(lower),
            number(upper),
            p.unit
        );
    }
    for (name, value) in fixed {
        let _ = writeln!(text, "{name:<width$} {:>12} {:>12}", number(*value), "fixed");
    }
    text
}

/// What was cut from a run's recording, and averaged: samples, periods.
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
            number(recorded.average),
            recorded.covered_s
        );
    }
    text
}

/// The width of a column of names.
fn width<'a>(names: impl Iterator<Item = &'a String>) -> usize {
    names.map(String::len).fold(28, usize::max)
}

/// Errors by level of each condition, in noise sds.
pub fn groups(comparison: &Comparison) -> String {
    if comparison.groups.is_empty() {
        return String::new();
    }
    let mut text = format!(
        "\n{:<8} {:<28} {:>18} {:>18} {:>18} {:>18}\n",
        "use", "sigma: rmse (mean) runs", "pull", "torque", "sinkage", "lateral"
    );
    for group in &comparison.groups {
        let _ = write!(text, "{:<8} {:<28}", group.usage, group.words());
        for channel in Channel::ALL {
            let error = group.channels.get(channel.name());
            let _ = write!(text, " {:>18}", error.map_or("-".into(), |e| e.words()));
        }
        text.push('\n');
    }
    text
}

/// The results of a study, one calibration after the other; of one that has grown without the tables of their runs.
pub fn study(study: &Study) -> String {
    let results: Vec<String> = match study.rounds.as_slice() {
        [] => study.all().map(summary).collect(),
        _ => study.all().map(brief).collect(),
    };
    let mut text = results.join("\n");
    for flag in study.missed_modes() {
        let _ = writeln!(text, "\nflag {}: {}", flag.kind, flag.text);
    }
    text
}

/// The result of a run: parameters, errors, table of model against measurement, flags.
pub fn summary(outcome: &FinishedCalibration) -> String {
    let compared = outcome.comparison();
    let table = if outcome.spec.experiment.runs.is_empty() {
        String::new()
    } else {
        comparison(&compared)
    };
    told(outcome, &compared, &table)
}

/// The same without the table.
fn brief(outcome: &FinishedCalibration) -> String {
    let compared = outcome.comparison();
    told(outcome, &compared, &errors(&compared))
}

fn told(outcome: &FinishedCalibration, compared: &Comparison, table: &str) -> String {
    let mut text = String::new();
    let row = &outcome.row;
    let how = match &outcome.estimate {
        Some(estimate) => format!(
            "{} stopped by {}",
            outcome.spec.method.name(),
            estimate.stop.name()
        ),
        None => format!("{} stages", outcome.stages.len()),
    };
    let _ = writeln!(
        text,
        "{}: {how}, {} evaluations ({} refused by the model), {:.1} s",
        outcome.experiment,
        row.evaluations.unwrap_or(0),
        row.rejected.unwrap_or(0),
        row.busy_ms as f64 / 1000.0
    );
    if let Some(metamodel) = &outcome.subchains {
        let _ = writeln!(
            text,
            "metamodel: {} moves by quasi_static in {} subchains, {} of which moved and were evaluated",
            metamodel.moves, metamodel.subchains, metamodel.moved
        );
    }
    if let (Some(z), Some(se)) = (row.log_evidence, row.log_evidence_se) {
        let _ = writeln!(text, "log-evidence {z:.2} +- {se:.2}");
    }
    if !outcome.spec.fit_variant.effects.is_empty() {
        let _ = writeln!(text, "model {}", outcome.spec.model_words());
    }
    if let Some(estimate) = &outcome.estimate {
        let _ = writeln!(text, "log-posterior {:.2}", estimate.log_posterior());
    }
    for words in error_model(outcome) {
        let _ = writeln!(text, "{words}");
    }
    text.push('\n');
    text.push_str(table);
    for error in reading_errors(outcome) {
        let _ = writeln!(text, "{}", error.words());
    }
    text.push_str(&match &outcome.estimate {
        Some(estimate) => point(outcome, estimate),
        None => parameters(outcome),
    });
    let diagnostics = outcome.diagnostics(compared);
    for words in [findings(&diagnostics), flags(&diagnostics)] {
        if !words.is_empty() {
            let _ = write!(text, "\n{words}");
        }
    }
    if let Some(note) = unsettled(outcome) {
        let _ = writeln!(text, "\nnote: {note}");
    }
    text
}

/// The most probable parameters, with their standard deviations after Laplace where they are known.
fn point(outcome: &FinishedCalibration, estimate: &EstimateRow) -> String {
    let width = width(outcome.spec.parameters.iter().map(|p| &p.name));
    let mut text = format!(
        "\n{:<width$} {:>10} {:>10}  {:<12} prior\n",
        "parameter", "best", "sd", "unit"
    );
    for p in fitted(estimate, &outcome.spec.parameters) {
        let _ = writeln!(
            text,
            "{:<width$} {:>10} {:>10}  {:<12} {}{}",
            p.free.name,
            number(p.value),
            p.sd.map_or("-".into(), number),
            p.free.unit,
            prior(p.free),
            if p.at_bound { "  AT BOUND" } else { "" }
        );
    }
    text
}

fn prior(free: &FreeParameter) -> String {
    format!(
        "{} +- {}",
        number(prior_mean(&free.marginal)),
        number(free.marginal.sd())
    )
}

/// The parameters after and before the data.
fn parameters(outcome: &FinishedCalibration) -> String {
    let mut text = String::new();
    let width = width(outcome.spec.parameters.iter().map(|p| &p.name));
    let _ = writeln!(
        text,
        "\n{:<width$} {:>10} {:>10} {:>10} {:>10} {:>10}  {:<12} prior",
        "parameter", "mean", "sd", "5 %", "95 %", "best", "unit"
    );
    for ((name, p), free) in outcome.parameter_summaries().iter().zip(&outcome.spec.parameters) {
        let prior = prior(free);
        let bound = if p.at_bound { "  AT BOUND" } else { "" };
        let _ = writeln!(
            text,
            "{name:<width$} {:>10} {:>10} {:>10} {:>10} {:>10}  {:<12} {prior}{bound}",
            number(p.mean),
            number(p.sd),
            number(p.q05),
            number(p.q95),
            number(p.map),
            free.unit
        );
    }
    text
}

/// Model against measurement, run by run, with errors by channel.
pub fn comparison(comparison: &Comparison) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{:<22} {:<8} {:>7} {:>8} {:<13} {:>10} {:>10} {:>23} {:>7}",
        "run", "use", "slip", "load N", "channel", "measured", "model", "90 % interval", "sigma"
    );
    for row in &comparison.rows {
        let (scale, _) = shown(row);
        let value = |v: Option<f64>| v.map_or("-".into(), |v| format!("{:.2}", v * scale));
        let interval = match row.q05 {
            Some(_) => format!("{} to {}", value(row.q05), value(row.q95)),
            None => "-".into(),
        };
        let _ = writeln!(
            text,
            "{:<22} {:<8} {:>7.3} {:>8.1} {:<13} {:>10} {:>10} {:>23} {:>7}",
            row.run,
            row.usage,
            row.slip,
            row.wheel_load_n,
            format!("{} {}", short(&row.channel), shown(row).1),
            value(Some(row.measured)),
            value(row.predicted),
            interval,
            row.residual_sigma.map_or("-".into(), |r| format!("{r:+.1}"))
        );
    }
    text.push('\n');
    text.push_str(&errors(comparison));
    text
}

/// Errors by channel, and how many measurements lie within their intervals.
fn errors(comparison: &Comparison) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{:<28} {:>16} {:>16} {:>16} {:>14} {:>8}",
        "root mean square error", "pull N", "torque N m", "sinkage mm", "lateral N", "sigma"
    );
    for (name, table) in [
        ("fit", &comparison.fit),
        ("holdout", &comparison.holdout),
        ("holdout, interpolation", &comparison.baseline_holdout),
    ] {
        if let Some(table) = table {
            text.push_str(&error_line(name, table));
        }
    }
    for usage in ["fit", "holdout"] {
        let rows = comparison.rows.iter().filter(|r| r.usage == usage);
        if let Some(coverage) = Coverage::count(rows) {
            let words = coverage.words();
            let _ = writeln!(text, "90 % intervals hold {words} {usage} measurements");
        }
    }
    text
}

fn error_line(name: &str, table: &ErrorTable) -> String {
    let cell = |c: Channel| {
        let scale = if c == Channel::Sinkage { 1000.0 } else { 1.0 };
        table
            .channel(c)
            .map_or("-".into(), |e| format!("{:.2} ({})", e.rmse * scale, e.runs))
    };
    let sigma = table.all.rmse_sigma.map_or("-".into(), |s| format!("{s:.2}"));
    format!(
        "{name:<28} {:>16} {:>16} {:>16} {:>14} {sigma:>8}\n",
        cell(Channel::DrawbarPull),
        cell(Channel::Torque),
        cell(Channel::Sinkage),
        cell(Channel::LateralForce)
    )
}

/// Where calibrations stand, a line each.
pub fn status_table(statuses: &[CalibrationStatus]) -> String {
    let mut text = format!(
        "{:>4} {:<24} {:<10} {:>5} {:>10} {:>11} {:>8} {:>8}\n",
        "id", "name", "state", "stage", "exponent", "evaluations", "per s", "to go s"
    );
    for s in statuses {
        let p = s.progress.as_ref();
        let cell = |value: Option<String>| value.unwrap_or_else(|| "-".into());
        let _ = writeln!(
            text,
            "{:>4} {:<24} {:<10} {:>5} {:>10} {:>11} {:>8} {:>8}",
            s.id,
            s.name,
            s.state.name(),
            cell(p.map(|p| p.stage.to_string())),
            cell(p.map(|p| format!("{:.3e}", p.tempering_exponent))),
            cell(p.map(|p| p.evaluations.to_string())),
            cell(p.map(|p| format!("{:.0}", p.evaluations_per_s))),
            cell(p.and_then(|p| p.remaining_s).map(|s| format!("{s:.0}")))
        );
        if let Some(message) = &s.message {
            let _ = writeln!(text, "     {message}");
        }
    }
    text
}

/// Factor and unit in which a row's channel is shown: sinkage in millimetres.
fn shown(row: &ComparisonRow) -> (f64, &str) {
    if row.channel == "sinkage" {
        (1000.0, "mm")
    } else {
        (1.0, &row.unit)
    }
}

fn short(channel: &str) -> &str {
    match channel {
        "drawbar_pull" => "pull",
        "lateral_force" => "lateral",
        other => other,
    }
}

/// Four significant digits.
pub(crate) fn number(x: f64) -> String {
    if x.abs() < f64::MIN_POSITIVE {
        "0".into()
    } else if (1e-3..1e5).contains(&x.abs()) {
        let digits = (3 - x.abs().log10().floor() as i32).max(0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.3e}")
    }
}
