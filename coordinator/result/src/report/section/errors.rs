//! Errors by channel, beside interpolation without physics.

use maud::{Markup, html};

use crate::finished_calibration::FinishedCalibration;
use crate::report::quantity::Quantity;
use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::errors::{ChannelError, ErrorTable};
use crate::table::readings::reading_errors;
use crate::table::row::ComparisonRow;
use crate::words::number;

/// A line of the table.
struct Line {
    rows: &'static str,
    predictor: &'static str,
    error: ChannelError,
    coverage: Option<Coverage>,
}

/// The table, with what its uncertainty is.
pub(in crate::report) fn errors(outcome: &FinishedCalibration, comparison: &Comparison) -> Markup {
    let intervals = outcome.estimate.is_none();
    let predicted = match outcome.estimate {
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
                @for quantity in Quantity::measured(&comparison.rows) {
                    @for (i, line) in lines(comparison, quantity).iter().enumerate() {
                        tr.first[i == 0] { (cells(quantity, i == 0, line, intervals)) }
                    }
                }
                @for (rows, table) in [("fit", &comparison.fit), ("holdout", &comparison.holdout)] {
                    @if let Some(table) = table { tr.first[rows == "fit"] { (all(comparison, rows, table, intervals)) } }
                }
            }
        } }
        @for error in reading_errors(outcome) { p { (error.words()) "." } }
        @if comparison.holdout.is_none() { p.note { "No holdout rows: the errors of prediction are not known." } }
        p.note {
            "Error: measured minus " (predicted) ". \u{b1} is the sampling error of a root mean square over n rows "
            "(itself over \u{221a}(2n)); repeats of one condition share their misfit, so the true uncertainty is larger. "
            "In units of the noise sd a perfect model scores about 1; so does any model whose noise was inferred. "
            "Interpolation: monotone cubic in slip between the fitted measurements of the same wheel, where it need not extrapolate. "
            @if intervals { "Expected: 95 % range of the count if the intervals are right and the rows independent." }
        }
    }
}

fn lines(comparison: &Comparison, quantity: Quantity) -> Vec<Line> {
    let rows = |usage: &'static str| {
        comparison
            .rows
            .iter()
            .filter(move |r| r.usage == usage && quantity.is_of(r))
    };
    let of = |table: &Option<ErrorTable>| table.as_ref().and_then(|t| t.channel(quantity.channel));
    let known = |r: &&ComparisonRow| r.interpolated.is_some();
    let baseline = of(&comparison.baseline_holdout);
    let holdout = of(&comparison.holdout);
    // Where interpolation has fewer rows, the model is shown on the same ones too.
    let same = baseline.filter(|b| holdout.is_some_and(|h| h.runs != b.runs));
    let same = same.and_then(|_| of(&ErrorTable::of_model(rows("holdout").filter(known))));
    let line = |rows, predictor, error: Option<ChannelError>, coverage| {
        error.map(|error| Line {
            rows,
            predictor,
            error,
            coverage,
        })
    };
    [
        line("fit", "model", of(&comparison.fit), Coverage::count(rows("fit"))),
        line("holdout", "model", holdout, Coverage::count(rows("holdout"))),
        line(
            "holdout, where interpolated",
            "model",
            same,
            Coverage::count(rows("holdout").filter(known)),
        ),
        line("holdout", "interpolation", baseline, None),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn cells(quantity: Quantity, first: bool, line: &Line, intervals: bool) -> Markup {
    let ChannelError {
        rmse,
        rmse_sigma,
        runs,
    } = line.error;
    html! {
        td.text { @if first { (quantity.channel.words()) } }
        td.text { (line.rows) }
        td.text { (line.predictor) }
        td { (sampled(rmse * quantity.scale, runs)) }
        td.text { (quantity.unit) }
        td { (rmse_sigma.map_or(number::NONE.into(), |s| sampled(s, runs))) }
        td { (runs) }
        @if intervals { td.text { (line.coverage.map_or(number::NONE.into(), Coverage::words)) } }
    }
}

fn all(comparison: &Comparison, rows: &'static str, table: &ErrorTable, intervals: bool) -> Markup {
    let of = || comparison.rows.iter().filter(|r| r.usage == rows);
    let counted = of().filter(|r| r.residual_sigma.is_some()).count();
    html! {
        td.text { @if rows == "fit" { "all together" } }
        td.text { (rows) }
        td.text { "model" }
        td {}
        td {}
        td { (table.all.rmse_sigma.map_or(number::NONE.into(), |s| sampled(s, counted))) }
        td { (of().filter(|r| r.predicted.is_some()).count()) }
        @if intervals { td.text { (Coverage::count(of()).map_or(number::NONE.into(), Coverage::words)) } }
    }
}

/// A root mean square over n rows with its sampling error.
fn sampled(rms: f64, n: usize) -> String {
    number::with_spread(rms, rms / (2.0 * n.max(1) as f64).sqrt())
}
