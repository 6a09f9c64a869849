//! Model against measurement as text.

use std::fmt::Write;

use shared::channel::Channel;

use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::errors::ErrorTable;
use crate::table::row::ComparisonRow;

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
pub(super) fn errors(comparison: &Comparison) -> String {
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
