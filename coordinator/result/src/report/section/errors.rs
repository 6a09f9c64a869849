//! Errors by channel, beside interpolation without physics.

use maud::{Markup, html};
use shared::channel::Channel;
use shared::experiment::RunUse;

use crate::finished_calibration::FinishedCalibration;
use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::errors::{ChannelError, ErrorTable};
use crate::table::readings::reading_errors;
use crate::table::row::{ComparisonRow, measured_channels, rows_of};
use crate::words::data_channel::ShownUnit;
use crate::words::number;

/// A line of the table.
struct ErrorLine {
    rows: &'static str,
    predictor: &'static str,
    error: ChannelError,
    coverage: Option<Coverage>,
}

/// The table, with its uncertainty explained.
pub(in crate::report) fn errors(calibration: &FinishedCalibration, comparison: &Comparison) -> Markup {
    let intervals = calibration.estimate.is_none();
    let predicted = match calibration.estimate {
        Some(_) => "the prediction at the most probable parameters",
        None => "the posterior-mean prediction",
    };
    html! {
        div.scroll { table {
            thead { tr {
                th.text { "channel" } th.text { "rows" } th.text { "predicted by" } th { "root mean square" br; "error" } th.text { "unit" }
                th { "in units of" br; "the noise sd" } th { "number" br; "of rows" } @if intervals { th.text { "inside the 90 % interval" } }
            } }
            tbody {
                @for channel in measured_channels(&comparison.rows) {
                    @for (i, line) in lines(comparison, channel).iter().enumerate() {
                        tr.first[i == 0] { (cells(channel, i == 0, line, intervals)) }
                    }
                }
                @for (rows, table) in [(RunUse::Fit, &comparison.fit), (RunUse::Holdout, &comparison.holdout)] {
                    @if let Some(table) = table { tr.first[rows == RunUse::Fit] { (all(comparison, rows, table, intervals)) } }
                }
            }
        } }
        @for error in reading_errors(calibration) { p { (error.words()) "." } }
        @if comparison.holdout.is_none() { p.note { "No holdout rows: the prediction errors are unknown." } }
        p.note {
            "Error: measured minus " (predicted) ". \u{b1} is the sampling error of a root mean square over n rows "
            "(itself over \u{221a}(2n)); repeats of one condition share their misfit, so the true uncertainty is larger. "
            "In units of the noise sd a perfect model scores about 1; so does any model whose noise was inferred. "
            "Interpolation: monotone cubic in slip between the fitted measurements of the same wheel, where it need not extrapolate. "
            @if intervals { "Expected: 95 % range of the count if the intervals are right and the rows independent." }
        }
    }
}

fn lines(comparison: &Comparison, channel: Channel) -> Vec<ErrorLine> {
    let rows = |usage| rows_of(&comparison.rows, usage).filter(move |r| r.channel == channel);
    let of = |table: &Option<ErrorTable>| table.as_ref().and_then(|t| t.channel(channel));
    let known = |r: &&ComparisonRow| r.interpolated.is_some();
    let baseline = of(&comparison.baseline_holdout);
    let holdout = of(&comparison.holdout);
    // Where interpolation has fewer rows, the model is shown on the same ones too.
    let same = baseline.filter(|b| holdout.is_some_and(|h| h.runs != b.runs));
    let same = same.and_then(|_| of(&ErrorTable::of_model(rows(RunUse::Holdout).filter(known))));
    let line = |rows, predictor, error: Option<ChannelError>, coverage| {
        error.map(|error| ErrorLine {
            rows,
            predictor,
            error,
            coverage,
        })
    };
    [
        line(
            "fit",
            "model",
            of(&comparison.fit),
            Coverage::count(rows(RunUse::Fit)),
        ),
        line(
            "holdout",
            "model",
            holdout,
            Coverage::count(rows(RunUse::Holdout)),
        ),
        line(
            "holdout, where interpolated",
            "model",
            same,
            Coverage::count(rows(RunUse::Holdout).filter(known)),
        ),
        line("holdout", "interpolation", baseline, None),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn cells(channel: Channel, first: bool, line: &ErrorLine, intervals: bool) -> Markup {
    let ChannelError {
        rmse,
        rmse_sigma,
        runs,
        ..
    } = line.error;
    let unit = ShownUnit::of(channel);
    html! {
        td.text { @if first { (channel.words()) } }
        td.text { (line.rows) }
        td.text { (line.predictor) }
        td { (sampled(rmse * unit.factor, runs)) }
        td.text { (unit.name) }
        td { (number::or_none(rmse_sigma, |s| sampled(s, runs))) }
        td { (runs) }
        @if intervals { td.text { (number::or_none(line.coverage, Coverage::words)) } }
    }
}

fn all(comparison: &Comparison, usage: RunUse, table: &ErrorTable, intervals: bool) -> Markup {
    let of = || rows_of(&comparison.rows, usage);
    let counted = of().filter(|r| r.residual_sigma.is_some()).count();
    html! {
        td.text { @if usage == RunUse::Fit { "all together" } }
        td.text { (usage.name()) }
        td.text { "model" }
        td {}
        td {}
        td { (number::or_none(table.all.rmse_sigma, |s| sampled(s, counted))) }
        td { (of().filter(|r| r.predicted.is_some()).count()) }
        @if intervals { td.text { (Coverage::count(of()).map_or(number::NONE.into(), Coverage::words)) } }
    }
}

/// A root mean square over n rows with its sampling error.
fn sampled(rms: f64, n: usize) -> String {
    number::with_spread(rms, rms / (2.0 * n.max(1) as f64).sqrt())
}
