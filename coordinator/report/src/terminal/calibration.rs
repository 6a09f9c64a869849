//! The results of one calibration as text.

use std::fmt::Write;

use job::FreeParameter;
use record::EstimateRow;

use super::column::{at_bound_words, cell, width};
use super::comparison::comparison;
use super::diagnostics::{findings, flags};
use super::table::Table;
use crate::diagnosis::diagnostics;
use crate::flag::unsettled_run::unsettled;
use result::finished_calibration::{FinishedCalibration, prior_mean};
use result::parameter_summary::ParameterSummary;
use result::point_estimate::{FittedParameter, fitted};
use result::table::error_model::error_model;
use result::table::readings::reading_errors;
use result::table::transient_errors::{PredictedTransient, TransientErrors};
use result::words::data_channel::ShownUnit;
use result::words::number;
use shared::channel::Channel;

/// Returns, for example, `hidden-effect: 14 stages, 16658 evaluations (3 rejected by the model), 1.5 s, log-evidence -1347.66`.
pub(super) fn headline(calibration: &FinishedCalibration) -> String {
    let row = &calibration.row;
    let how = match calibration.mode() {
        Some(estimate) => format!(
            "{} stopped by {}",
            calibration.spec.algorithm.name(),
            estimate.stop.name()
        ),
        None => number::count(calibration.stages().len(), "stage"),
    };
    let rejected = match row.rejected {
        None | Some(0) => String::new(),
        Some(n) => format!(" ({n} rejected by the model)"),
    };
    let evidence = row.log_evidence.map(|z| format!(", log-evidence {z:.2}"));
    format!(
        "{}: {how}, {}{rejected}, {}{}",
        calibration.experiment,
        number::count(row.evaluations.unwrap_or(0) as usize, "evaluation"),
        number::duration(row.busy_ms as f64 / 1000.0),
        evidence.unwrap_or_default()
    )
}

/// Returns the results of a calibration: model against measurement, errors, parameters, findings, flags.
pub(super) fn summary(calibration: &FinishedCalibration) -> String {
    let compared = calibration.comparison();
    let mut text = headline(calibration) + "\n";
    let row = &calibration.row;
    let fit = calibration.mode();
    if calibration.approximated().is_some() {
        let _ = writeln!(
            text,
            "normal approximation: {} about the most probable parameters",
            number::count(calibration.posterior().len(), "draw")
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
    if !calibration.spec.experiment.runs.is_empty() {
        text.push_str(&comparison(compared));
    }
    for error in reading_errors(calibration) {
        let _ = writeln!(text, "{}", error.words());
    }
    text.push_str(&transients(&calibration.predicted_transients(compared)));
    text.push_str(&match calibration.estimate() {
        Some(estimate) => point(calibration, estimate),
        None => parameters(calibration),
    });
    let diagnostics = diagnostics(calibration, compared);
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

/// Tabulates the errors of the sinkage before the steady state by group of runs; empty without transients.
fn transients(predicted: &[PredictedTransient]) -> String {
    let groups = TransientErrors::by_group(predicted);
    if groups.is_empty() {
        return String::new();
    }
    let millimetres = |m: f64| number::significant(ShownUnit::new(Channel::Sinkage).factor * m, 2);
    let table = Table::<&TransientErrors>::new()
        .left(28, "sinkage before it is steady", |errors| {
            match errors.holdout_group {
                None => errors.usage.name(),
                Some(group) => group.words(),
            }
        })
        .right(6, "runs", |errors| errors.runs.to_string())
        .right(12, "error mm", |errors| millimetres(errors.rmse_m))
        .right(14, "corrected mm", |errors| {
            cell(errors.corrected_rmse_m, millimetres)
        });
    table.text(&groups) + "\n"
}

/// Tabulates the most probable parameters, with the standard deviations of the Laplace approximation if they are known.
fn point(calibration: &FinishedCalibration, estimate: &EstimateRow) -> String {
    let parameters = &calibration.spec.parameters;
    let value = |p: &FittedParameter| match p.sd {
        Some(sd) => number::to_spread(p.value, sd),
        None => number::four_digits(p.value),
    };
    let fitted: Vec<FittedParameter> = fitted(estimate, parameters).collect();
    let table = Table::<&FittedParameter>::new()
        .left(width(parameters.iter().map(|p| &p.name)), "parameter", |p| {
            &p.free.name
        })
        .right(10, "best", value)
        .right(10, "sd", |p| cell(p.sd, |sd| number::to_spread(sd, sd)))
        .apart(12, "unit", |p| &p.free.unit)
        .left(0, "prior", |p| prior(p.free, p.at_bound));
    format!("\n{}", table.text(&fitted))
}

/// Describes the prior of a parameter, and says whether the parameter lies at its bound.
fn prior(free: &FreeParameter, at_bound: bool) -> String {
    let sd = free.marginal.sd();
    format!(
        "{} +- {}{}",
        number::to_spread(prior_mean(&free.marginal), sd),
        number::to_spread(sd, sd),
        at_bound_words(at_bound)
    )
}

/// Tabulates the posterior and the prior of each parameter.
fn parameters(calibration: &FinishedCalibration) -> String {
    let width = width(calibration.spec.parameters.iter().map(|p| &p.name));
    let summaries = calibration.parameter_summaries();
    let table = Table::<(&(String, ParameterSummary), &FreeParameter)>::new()
        .left(width, "parameter", |((name, _), _)| name)
        .right(10, "mean", |((_, p), _)| number::to_spread(p.mean, p.sd))
        .right(10, "sd", |((_, p), _)| number::to_spread(p.sd, p.sd))
        .right(10, "5 %", |((_, p), _)| number::to_spread(p.q05, p.sd))
        .right(10, "95 %", |((_, p), _)| number::to_spread(p.q95, p.sd))
        .right(10, "best", |((_, p), _)| number::to_spread(p.map, p.sd))
        .apart(12, "unit", |(_, free)| &free.unit)
        .left(0, "prior", |((_, p), free)| prior(free, p.at_bound));
    format!(
        "\n{}",
        table.text(summaries.iter().zip(&calibration.spec.parameters))
    )
}
