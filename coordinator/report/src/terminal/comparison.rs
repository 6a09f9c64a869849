//! The comparison of a model with the measurements as text.

use std::fmt::Write;

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::column::cell;
use super::table::{Table, channel_title};
use result::table::comparison::Comparison;
use result::table::coverage::Coverage;
use result::table::errors::ErrorTable;
use result::table::group::ErrorGroup;
use result::table::row::{ComparisonRow, rows_of};
use result::words::data_channel::{ShownUnit, short_name};
use result::words::number;

/// Tabulates the model against the measurements, run by run, with errors by channel.
pub fn comparison(comparison: &Comparison) -> String {
    let measured = match comparison.digitised {
        true => "digitised",
        false => "measured",
    };
    let value = |row: &ComparisonRow, v: Option<f64>| {
        cell(v, |v| format!("{:.2}", v * ShownUnit::new(row.channel).factor))
    };
    let interval = |row: &ComparisonRow, q05: Option<f64>, q95: Option<f64>| match q05 {
        Some(_) => format!("{} to {}", value(row, q05), value(row, q95)),
        None => "-".into(),
    };
    let table = Table::<&ComparisonRow>::new()
        .left(22, "run", |row| &row.run)
        .left(8, "use", |row| row.usage.name())
        .right(7, "slip", |row| format!("{:.3}", row.slip))
        .right(8, "load N", |row| format!("{:.1}", row.wheel_load_n))
        .left(13, "channel", |row| channel_title(row.channel))
        .right(10, measured, |row| value(row, Some(row.measured)))
        .right(10, "model", |row| value(row, row.predicted))
        .right(23, "90 % interval", |row| interval(row, row.q05, row.q95))
        .right(7, "sigma", |row| cell(row.residual_sigma, |r| format!("{r:+.1}")))
        .right(10, "corrected", |row| value(row, row.corrected))
        .right(23, "90 % interval", |row| {
            interval(row, row.corrected_q05, row.corrected_q95)
        });
    let mut text = table.text(&comparison.rows);
    text.push_str(&refused(comparison));
    text.push('\n');
    text.push_str(&errors(comparison));
    text
}

/// Returns a line for each run that the model refuses at some draw.
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

/// Tabulates the errors by channel, and counts the measurements within their intervals.
fn errors(comparison: &Comparison) -> String {
    let mut table = Table::<(&str, &ErrorTable)>::new().left(28, "root mean square error", |(name, _)| name);
    for channel in Channel::ALL {
        let width = if channel == Channel::LateralForce { 14 } else { 16 };
        table = table.right(width, &channel_title(channel), move |(_, errors)| {
            let scale = ShownUnit::new(channel).factor;
            cell(errors.channel(channel), |e| {
                format!("{:.2} ({})", e.rmse * scale, e.runs)
            })
        });
    }
    let table = table.right(8, "sigma", |(_, errors)| {
        cell(errors.all.rmse_sigma, |s| format!("{s:.2}"))
    });
    let rows = [
        ("fit", &comparison.fit),
        ("fit, corrected", &comparison.corrected_fit),
        ("holdout", &comparison.holdout),
        ("holdout, corrected", &comparison.corrected_holdout),
        ("holdout, interpolation", &comparison.baseline_holdout),
    ];
    let rows = rows
        .into_iter()
        .filter_map(|(name, errors)| Some((name, errors.as_ref()?)));
    let mut text = table.text(rows);
    let unpredicted = [&comparison.fit, &comparison.holdout].map(|table| {
        let of_table = table.as_ref().map(|table| table.all.unpredicted);
        of_table.unwrap_or_default()
    });
    for (usage, unpredicted) in [RunUse::Fit, RunUse::Holdout].into_iter().zip(unpredicted) {
        if unpredicted > 0 {
            let measurements = number::count(unpredicted, "measurement");
            // A fitted run is judged by the accepted draws, however few.
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

/// Tabulates the errors by level of each condition, in noise standard deviations.
pub fn groups(comparison: &Comparison) -> String {
    if comparison.groups.is_empty() {
        return String::new();
    }
    let mut table = Table::<&ErrorGroup>::new()
        .left(8, "use", |group| group.usage.name())
        .left(28, "sigma: rmse (mean) runs", ErrorGroup::words);
    for channel in Channel::ALL {
        table = table.right(18, short_name(channel), move |group| {
            cell(group.channels.get(channel.name()), |e| e.words())
        });
    }
    format!("\n{}", table.text(&comparison.groups))
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
