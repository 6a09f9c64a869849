//! A recording that is followed, as text.

use std::fmt::Write;

use prediction::recording::{FollowedRecording, RecordedTime};
use result::number;

/// The titles of [`recorded_rows`].
pub const RECORDING_TITLES: &str = "t_s,parameter,median,q05,q95,change_probability\n";

/// Returns the parameters at a time as a line, with a line before it where a change is flagged.
pub fn recorded_time(time: &RecordedTime) -> String {
    let mut text = String::new();
    // Writing to a text cannot fail.
    if let Some(change) = &time.change {
        let _ = writeln!(
            text,
            "CHANGE of the soil at {:.1} s, found at {:.1} s (probability {:.3})",
            change.t_s, change.found_s, change.probability
        );
    }
    let _ = write!(text, "{:.1} s", time.t_s);
    for parameter in &time.parameters {
        let [median, low, high] = [parameter.median, parameter.interval[0], parameter.interval[1]]
            .map(|value| number::significant(value, 4));
        let _ = write!(text, "  {} {median} ({low} to {high})", parameter.name);
    }
    text.push_str(if time.is_refused {
        "  the model refuses the samples\n"
    } else {
        "\n"
    });
    text
}

/// Returns the parameters at a time as rows of a table.
pub fn recorded_rows(time: &RecordedTime) -> String {
    let rows = time.parameters.iter().map(|parameter| {
        let [low, high] = parameter.interval;
        format!(
            "{},{},{},{low},{high},{}\n",
            time.t_s, parameter.name, parameter.median, time.change_probability
        )
    });
    rows.collect()
}

/// Returns the changes, the size of the walk and the noise at the end of a recording.
pub fn recording_end(followed: &FollowedRecording) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{} changes of the soil", followed.changes.len());
    for change in &followed.changes {
        let _ = writeln!(text, "  at {:.1} s, found at {:.1} s", change.t_s, change.found_s);
    }
    let shown = |x: f64| number::significant(x, 3);
    let sizes = followed
        .walk
        .iter()
        .map(|size| format!("{} ({:.2})", size.prior_sds, size.probability));
    let sizes = sizes.collect::<Vec<_>>().join(", ");
    let _ = writeln!(
        text,
        "walk in a second, in standard deviations of the prior (probability): {sizes}"
    );
    for noise in &followed.noise {
        let _ = writeln!(
            text,
            "noise of {}: {} a sample, {} samples are worth one",
            noise.channel,
            shown(noise.sd),
            shown(noise.correlated_samples)
        );
    }
    if followed.noise.is_empty() {
        text.push_str("the recording is too short: the noise is known from 50 samples on\n");
    }
    text
}
