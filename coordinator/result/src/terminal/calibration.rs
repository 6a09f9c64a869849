//! Tables for a terminal.

use std::fmt::Write;

use job::FreeParameter;
use record::EstimateRow;

use super::column::width;
use super::comparison::{comparison, errors};
use super::diagnostics::{findings, flags};
use crate::finished_calibration::{FinishedCalibration, prior_mean};
use crate::flag::unsettled_run::unsettled;
use crate::summary::point_estimate::fitted;
use crate::table::comparison::Comparison;
use crate::table::error_model::error_model;
use crate::table::readings::reading_errors;
use crate::words::number;

/// The result of a run: parameters, errors, table of model against measurement, flags.
pub(super) fn summary(outcome: &FinishedCalibration) -> String {
    let compared = outcome.comparison();
    let table = if outcome.spec.experiment.runs.is_empty() {
        String::new()
    } else {
        comparison(&compared)
    };
    told(outcome, &compared, &table)
}

/// The same without the table.
pub(super) fn brief(outcome: &FinishedCalibration) -> String {
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
            number::four_digits(p.value),
            p.sd.map_or("-".into(), number::four_digits),
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
        number::four_digits(prior_mean(&free.marginal)),
        number::four_digits(free.marginal.sd())
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
            number::four_digits(p.mean),
            number::four_digits(p.sd),
            number::four_digits(p.q05),
            number::four_digits(p.q95),
            number::four_digits(p.map),
            free.unit
        );
    }
    text
}
