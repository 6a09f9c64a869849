//! Model against measurement: a picture for each wheel and channel, then every run.

use std::collections::BTreeSet;

use maud::{Markup, html};
use shared::channel::Channel;
use shared::experiment::RunUse;

use crate::finished_calibration::FinishedCalibration;
use crate::report::chart::{ComparisonChart, Marker, glyph, shared_range};
use crate::table::comparison::Comparison;
use crate::table::row::{ComparisonRow, measured_channels};
use crate::words::data_channel::{ShownUnit, title};
use crate::words::number;

/// Pictures and table.
pub(in crate::report) fn comparison(calibration: &FinishedCalibration, comparison: &Comparison) -> Markup {
    let rows = &comparison.rows;
    let wheels: BTreeSet<&str> = rows.iter().map(|r| r.wheel.as_str()).collect();
    let has_holdout = rows.iter().any(|r| r.usage == RunUse::Holdout);
    let draws = calibration
        .predictive_draws()
        .iter()
        .filter(|p| p.fit.is_ok())
        .count();
    let sampled = calibration.estimate.is_none();
    let model = if sampled {
        "model: posterior mean and 90 % predictive interval"
    } else {
        "model at the most probable parameters"
    };
    html! {
        div.legend {
            span { (glyph(Some(Marker::Fit))) "measured, fitted" }
            @if has_holdout { span { (glyph(Some(Marker::Holdout))) "measured, held out" } }
            span { (glyph(None)) (model) }
        }
        @if wheels.len() == 1 {
            div.charts { @for channel in measured_channels(rows) { (panels(rows, &wheels, channel)) } }
        } @else {
            @for channel in measured_channels(rows) {
                h3 { (title(channel)) }
                div.charts { (panels(rows, &wheels, channel)) }
            }
        }
        p.note {
            "Runs at the same condition stand side by side. A dashed line joins predictions and only guides the eye. "
            @if sampled {
                "An interval should contain 90 % of new measurements: spread of the parameters over "
                (number::count(draws, "draw")) " of the posterior, plus the noise. "
            } @else {
                "A fit has no distribution, so there are no intervals. "
            }
            "Slip < 0: the wheel is braked; > 0: it drives. Sinkage > 0: the rim lies below the undisturbed surface."
        }
        details {
            summary { "Table of all runs (" (number::count(rows.len(), "measurement")) ")" }
            div.scroll { (table(rows, sampled)) }
        }
    }
}

/// A picture for each wheel that has the channel.
fn panels(rows: &[ComparisonRow], wheels: &BTreeSet<&str>, channel: Channel) -> Markup {
    let (wheels, charts): (Vec<&str>, Vec<ComparisonChart>) = wheels
        .iter()
        .filter_map(|w| Some((*w, ComparisonChart::new(rows, w, channel)?)))
        .unzip();
    let range = shared_range(&charts);
    html! {
        @for (wheel, chart) in wheels.iter().zip(&charts) {
            figure { figcaption { "wheel " b { (wheel) } ", " (channel.words()) } (chart.draw(range)) }
        }
    }
}

fn table(rows: &[ComparisonRow], sampled: bool) -> Markup {
    let angles = rows.iter().any(|r| r.slip_angle_deg.abs() > 0.0);
    let holdout = rows.iter().any(|r| r.usage == RunUse::Holdout);
    html! {
        table {
            thead { tr {
                th.text { "run" } th.text { "use" } th.text { "wheel" } th { "slip" } th { "load" br; "N" } th { "speed" br; "mm/s" }
                @if angles { th { "slip angle" br; "deg" } }
                th.text { "channel" } th { "measured" } th { "model" @if sampled { br; "mean" } } @if sampled { th { "90 % predictive" br; "interval" } }
                th { "residual" br; "noise sd" }
                @if holdout { th { "inter-" br; "polation" } }
            } }
            tbody {
                @for (i, row) in rows.iter().enumerate() {
                    @let new_run = i == 0 || rows[i - 1].run != row.run;
                    tr.first[new_run] { (cells(row, angles, holdout, sampled)) }
                }
            }
        }
    }
}

fn cells(row: &ComparisonRow, angles: bool, holdout: bool, sampled: bool) -> Markup {
    let unit = ShownUnit::of(row.channel);
    let spread = row
        .noise_sd
        .or(row.q05.zip(row.q95).map(|(a, b)| 0.3 * (b - a)))
        .unwrap_or(0.0);
    // One digit more than the noise deserves: rows are compared with each other.
    let value = |v: Option<f64>| {
        number::or_none(v, |v| {
            number::to_spread(v * unit.factor, 0.3 * spread * unit.factor)
        })
    };
    html! {
        td.text { (row.run) } td.text { (row.usage.name()) } td.text { (row.wheel) }
        td { (number::fixed(row.slip, 3)) } td { (number::fixed(row.wheel_load_n, 1)) }
        td { (number::fixed(row.sled_speed_m_s * 1000.0, 2)) }
        @if angles { td { (number::fixed(row.slip_angle_deg, 1)) } }
        td.text { (title(row.channel)) }
        td { (value(Some(row.measured))) } td { (value(row.predicted)) }
        @if sampled {
            td { @if row.q05.is_some() { (value(row.q05)) " to " (value(row.q95)) } @else { (number::NONE) } }
        }
        td {
            @if row.covered() == Some(false) { span.alarm { "outside " } }
            (number::or_none(row.residual_sigma, |r| format!("{r:+.1}")))
        }
        @if holdout { td { (value(row.interpolated)) } }
    }
}
