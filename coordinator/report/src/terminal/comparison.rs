//! Model against measurement as text.

use std::fmt::Write;

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::column::cell;
use result::table::comparison::Comparison;
use result::table::coverage::Coverage;
use result::table::errors::ErrorTable;
use result::table::row::rows_of;
use result::words::data_channel::{ShownUnit, short_name};
use result::words::number;

/// Model against measurement, run by run, with errors by channel.
pub fn comparison(comparison: &Comparison) -> String {
    let mut text = String::new();
    let measured = if comparison.digitised {
        "digitised"
    } else {
        "measured"
    };
    let _ = writeln!(
        text,
        "{:<22} {:<8} {:>7} {:>8} {:<13} {:>10} {:>10} {:>23} {:>7} {:>10} {:>23}",
        "run",
        "use",
        "slip",
        "load N",
        "channel",
        measured,
        "model",
        "90 % interval",
        "sigma",
        "corrected",
        "90 % interval"
    );
    for row in &comparison.rows {
        let unit = ShownUnit::of(row.channel);
        let value = |v: Option<f64>| cell(v, |v| format!("{:.2}", v * unit.factor));
        let interval = |q05: Option<f64>, q95: Option<f64>| match q05 {
            Some(_) => format!("{} to {}", value(q05), value(q95)),
            None => "-".into(),
        };
        let _ = writeln!(
            text,
            "{:<22} {:<8} {:>7.3} {:>8.1} {:<13} {:>10} {:>10} {:>23} {:>7} {:>10} {:>23}",
            row.run,
            row.usage.name(),
            row.slip,
            row.wheel_load_n,
            format!("{} {}", short_name(row.channel), unit.name),
            value(Some(row.measured)),
            value(row.predicted),
            interval(row.q05, row.q95),
            cell(row.residual_sigma, |r| format!("{r:+.1}")),
            value(row.corrected),
            interval(row.corrected_q05, row.corrected_q95)
        );
    }
    text.push_str(&refused(comparison));
    text.push('\n');
    text.push_str(&errors(comparison));
    text
}

/// A line for each run that the model refuses at some draw.
fn refused(comparison: &Comparison) -> String {
    let mut lines: Vec<String> = Vec::new();
    for row in &comparison.rows {
        if let Some(refusal) = &row.refused {
            let judged = match row.predicted {
                Some(_) => "",
                None => ": not judged",
            };
            let line = format!(
                "{}: the model refuses it at {}{judged}\n",
                row.run,
                refusal.words()
            );
            if lines.last() != Some(&line) {
                lines.push(line);
            }
        }
    }
    lines.concat()
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
        ("fit, corrected", &comparison.corrected_fit),
        ("holdout", &comparison.holdout),
        ("holdout, corrected", &comparison.corrected_holdout),
        ("holdout, interpolation", &comparison.baseline_holdout),
    ] {
        if let Some(table) = table {
            text.push_str(&error_line(name, table));
        }
    }
    let unpredicted = [&comparison.fit, &comparison.holdout].map(|table| {
        let of_table = table.as_ref().map(|table| table.all.unpredicted);
        of_table.unwrap_or_default()
    });
    for (usage, unpredicted) in [RunUse::Fit, RunUse::Holdout].into_iter().zip(unpredicted) {
        if unpredicted > 0 {
            let measurements = number::count(unpredicted, "measurement");
            // A fitted run is judged by whatever draws are left.
            let which = match usage {
                RunUse::Fit => "that have no prediction",
                RunUse::Holdout => "that the model refuses at half of the draws or more",
            };
            let _ = writeln!(text, "without {measurements} of {} runs {which}", usage.name());
        }
    }
    for usage in [RunUse::Fit, RunUse::Holdout] {
        let rows = || rows_of(&comparison.rows, usage);
        for (whose, coverage) in [
            ("", Coverage::count(rows())),
            (" of corrected predictions", Coverage::count_corrected(rows())),
        ] {
            if let Some(coverage) = coverage {
                let (words, usage) = (coverage.words(), usage.name());
                let _ = writeln!(text, "90 % intervals{whose} contain {words} {usage} measurements");
            }
        }
    }
    if comparison.corrected_fit.is_some() {
        text.push_str(
            "corrected: with what the model misses in the fitted conditions, of a fitted run in the others\n",
        );
    }
    for reason in &comparison.not_corrected {
        let _ = writeln!(text, "not corrected: {reason}");
    }
    text
}

fn error_line(name: &str, table: &ErrorTable) -> String {
    let rmse = |c: Channel| {
        let scale = ShownUnit::of(c).factor;
        table
            .channel(c)
            .map_or("-".into(), |e| format!("{:.2} ({})", e.rmse * scale, e.runs))
    };
    let sigma = cell(table.all.rmse_sigma, |s| format!("{s:.2}"));
    format!(
        "{name:<28} {:>16} {:>16} {:>16} {:>14} {sigma:>8}\n",
        rmse(Channel::DrawbarPull),
        rmse(Channel::Torque),
        rmse(Channel::Sinkage),
        rmse(Channel::LateralForce)
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
        let _ = write!(text, "{:<8} {:<28}", group.usage.name(), group.words());
        for channel in Channel::ALL {
            let error = group.channels.get(channel.name());
            let _ = write!(text, " {:>18}", cell(error, |e| e.words()));
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use shared::experiment::RunUse;

    use crate::diagnosis::diagnostics;
    use crate::fixture;

    #[test]
    fn the_flag_the_story_and_the_terminal_name_what_is_refused() {
        let refused = fixture::with_refused_runs();
        let comparison = refused.comparison();
        let flags = diagnostics(&refused, comparison).flags;
        let flag = flags.iter().find(|f| f.text.contains("held-out")).unwrap();
        assert_eq!(
            flag.text,
            "the model refuses 3 of 4 held-out runs: h1 at 19 of 19 final draws (no_support: condition 0: z = 0.11 m), h2 at 10 of 19 \
             final draws (no_support: condition 0: z = 0.11 m) and h3 at 5 of 19 final draws (no_support: condition 0: z = 0.11 m); \
             they lie outside its validity; 2 of them, refused at half of the draws or more, are not judged, and errors and coverage \
             are over the other 2 held-out runs"
        );
        let text = crate::terminal::comparison(comparison);
        for words in [
            "\nh1: the model refuses it at 19 of 19 final draws (no_support",
            ": not judged\n",
            "\nwithout 2 measurements of holdout runs that the model refuses at half of the draws or more\n",
            "90 % intervals contain 2 of 2 (",
        ] {
            assert!(text.contains(words), "{words} in {text}");
        }
    }

    #[test]
    fn the_terminal_shows_a_line_for_each_group() {
        let calibration = fixture::calibration();
        let comparison = calibration.comparison();
        let text = crate::terminal::groups(comparison);
        assert_eq!(text.lines().count(), 2 + comparison.groups.len());
        let line = text.lines().find(|line| line.starts_with("holdout  slip 0.400"));
        let pull = comparison
            .groups
            .iter()
            .find(|g| g.usage == RunUse::Holdout)
            .unwrap()
            .channels["drawbar_pull"];
        assert!(line.unwrap().contains(&pull.words()), "{text}");
    }
}
