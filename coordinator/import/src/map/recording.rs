//! The table `[recording]` of a map.

use toml_edit::TableLike;

use super::content::{Mark, Recording};
use super::entry::{Keys, Source};
use crate::complaint::Complaints;

pub(super) fn read(
    source: &Source<'_>,
    table: &dyn TableLike,
    complaints: &mut Complaints,
) -> Option<Recording> {
    let mut keys = Keys::new(source, table, "[recording]", Some("recording"));
    let time = keys.text(complaints, "time");
    let time_unit = keys.text(complaints, "time_unit");
    let mark = mark(&mut keys, complaints);
    let window = keys.list(complaints, "window_s");
    let step_s = keys.positive(complaints, "step_s");
    let histories = keys.flag(complaints, "histories");
    keys.end(complaints);
    let window_s = self::window(&window, &mut keys, complaints);
    let (Some(time), Some(time_unit)) = (time, time_unit) else {
        let message = "a recording needs time (a column) and time_unit";
        keys.complain(complaints, "", message);
        return None;
    };
    let line = table
        .iter()
        .next()
        .and_then(|(_, item)| item.span())
        .map_or(1, |span| source.line(span.start));
    keys.is_right.then_some(Recording {
        line,
        time,
        time_unit,
        mark,
        window_s,
        step_s,
        histories,
    })
}

/// Returns what a run is told by: a column, a condition, or that it is the file.
fn mark(keys: &mut Keys<'_>, complaints: &mut Complaints) -> Mark {
    let marker = keys.text(complaints, "marker");
    let between = keys.list(complaints, "between");
    let condition = keys.text(complaints, "while");
    let shortest_s = keys.positive(complaints, "shortest_s");
    let mut lacks = |key: &str, other: &str| {
        let message = format!("{key} belongs to `{other}`, which the map does not have");
        keys.complain(complaints, key, message);
    };
    if marker.is_none() && !between.is_empty() {
        lacks("between", "marker");
    }
    if condition.is_none() && shortest_s.is_some() {
        lacks("shortest_s", "while");
    }
    match (marker, condition) {
        (Some(_), Some(_)) => {
            let message = "a run is told by marker or by while: leave one of them out";
            keys.complain(complaints, "while", message);
            Mark::File
        }
        (Some(name), None) => Mark::Column {
            name,
            between: between.into_iter().collect(),
        },
        (None, Some(text)) => Mark::Condition {
            text,
            shortest_s: shortest_s.unwrap_or(0.0),
        },
        (None, None) => Mark::File,
    }
}

fn window(window: &[String], keys: &mut Keys<'_>, complaints: &mut Complaints) -> Option<(f64, f64)> {
    match window {
        [] => None,
        [from, to] => match (from.parse(), to.parse()) {
            (Ok(from), Ok(to)) if 0.0 <= from && from < to => Some((from, to)),
            _ => {
                let message = format!("[{from}, {to}] must be two times in s, the second after the first");
                keys.complain(complaints, "window_s", message);
                None
            }
        },
        _ => {
            let message = "window_s must be two times in s, as [20, 60]";
            keys.complain(complaints, "window_s", message);
            None
        }
    }
}
