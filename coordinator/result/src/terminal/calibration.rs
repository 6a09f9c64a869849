//! Tables for a terminal.

use std::fmt::Write;

use job::FreeParameter;
use record::EstimateRow;

use super::column::{cell, width};
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
pub(super) fn summary(calibration: &FinishedCalibration) -> String {
    let compared = calibration.comparison();
    let table = if calibration.spec.experiment.runs.is_empty() {
        String::new()
    } else {
        comparison(&compared)
    };
    told(calibration, &compared, &table)
}

/// The same without the table.
pub(super) fn brief(calibration: &FinishedCalibration) -> String {
    let compared = calibration.comparison();
    told(calibration, &compared, &errors(&compared))
}

fn told(calibration: &FinishedCalibration, compared: &Comparison, table: &str) -> String {
    let mut text = String::new();
    let row = &calibration.row;
    let fit = calibration
        .estimate
        .as_ref()
        .or(calibration.approximated.as_ref());
    let how = match fit {
        Some(estimate) => format!(
            "{} stopped by {}",
            calibration.spec.algorithm.name(),
            estimate.stop.name()
        ),
        None => number::count(calibration.stages.len(), "stage"),
    };
    let _ = writeln!(
        text,
        "{}: {how}, {} ({} rejected by the model), {:.1} s",
        calibration.experiment,
        number::count(row.evaluations.unwrap_or(0) as usize, "evaluation"),
        row.rejected.unwrap_or(0),
        row.busy_ms as f64 / 1000.0
    );
    if let Some(metamodel) = &calibration.subchains {
        let _ = writeln!(
            text,
            "metamodel: {} of quasi_static in {}, {} of which moved and were evaluated",
            number::count(metamodel.moves as usize, "move"),
            number::count(metamodel.subchains as usize, "subchain"),
            metamodel.moved
        );
    }
    if calibration.approximated.is_some() {
        let _ = writeln!(
            text,
            "normal approximation: {} about the most probable parameters",
            number::count(calibration.posterior.len(), "draw")
        );
    }
    match (row.log_evidence, row.log_evidence_se) {
        (Some(z), Some(se)) => drop(writeln!(text, "log-evidence {z:.2} +- {se:.2}")),
        (Some(z), None) => drop(writeln!(text, "log-evidence {z:.2} by the normal approximation")),
        (None, _) => {}
    }
    if !calibration.spec.fit_variant.effects.is_empty() {
        let _ = writeln!(text, "model {}", calibration.spec.model_words());
    }
    if let Some(estimate) = fit {
        let _ = writeln!(text, "log-posterior {:.2}", estimate.log_posterior());
    }
    for words in error_model(calibration) {
        let _ = writeln!(text, "{words}");
    }
    text.push('\n');
    text.push_str(table);
    for error in reading_errors(calibration) {
        let _ = writeln!(text, "{}", error.words());
    }
    text.push_str(&match &calibration.estimate {
        Some(estimate) => point(calibration, estimate),
        None => parameters(calibration),
    });
    let diagnostics = calibration.diagnostics(compared);
    for words in [findings(&diagnostics), flags(&diagnostics)] {
        if !words.is_empty() {
            let _ = write!(text, "\n{words}");
        }
    }
    if let Some(note) = unsettled(calibration) {
        let _ = writeln!(text, "\nnote: {note}");
    }
    text
}

/// The most probable parameters, with their standard deviations after Laplace where they are known.
fn point(calibration: &FinishedCalibration, estimate: &EstimateRow) -> String {
    let width = width(calibration.spec.parameters.iter().map(|p| &p.name));
    let mut text = format!(
        "\n{:<width$} {:>10} {:>10}  {:<12} prior\n",
        "parameter", "best", "sd", "unit"
    );
    for p in fitted(estimate, &calibration.spec.parameters) {
        let _ = writeln!(
            text,
            "{:<width$} {:>10} {:>10}  {:<12} {}{}",
            p.free.name,
            number::four_digits(p.value),
            cell(p.sd, number::four_digits),
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
fn parameters(calibration: &FinishedCalibration) -> String {
    let mut text = String::new();
    let width = width(calibration.spec.parameters.iter().map(|p| &p.name));
    let _ = writeln!(
        text,
        "\n{:<width$} {:>10} {:>10} {:>10} {:>10} {:>10}  {:<12} prior",
        "parameter", "mean", "sd", "5 %", "95 %", "best", "unit"
    );
    for ((name, p), free) in calibration
        .parameter_summaries()
        .iter()
        .zip(&calibration.spec.parameters)
    {
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
