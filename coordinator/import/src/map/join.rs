//! The layout of a file in a map, and the tables `[join]` of files that join a recording.

use toml_edit::TableLike;

use super::content::{Join, Layout, QUESTION};
use super::entry::{Keys, Source};
use crate::complaint::Complaints;
use crate::number::Decimal;
use crate::pattern::Pattern;
use crate::read::Hints;

/// Reads the statements about the layout of a file.
pub(super) fn layout(keys: &mut Keys<'_>, complaints: &mut Complaints) -> Layout {
    Layout {
        hints: Hints {
            sheet: keys.scalar(complaints, "sheet"),
            encoding: keys.text(complaints, "encoding"),
            separator: keys.text(complaints, "separator"),
            takes_largest: false,
        },
        titles: keys.line_number(complaints, "titles"),
        units: keys.line_number(complaints, "units"),
        decimal: decimal(keys, complaints),
    }
}

pub(super) fn decimal(keys: &mut Keys<'_>, complaints: &mut Complaints) -> Option<Decimal> {
    let mark = keys.text(complaints, "decimal")?;
    let decimal = Decimal::from_mark(&mark);
    if mark == QUESTION {
        keys.ask(complaints, "decimal", "decimal = \"?\" asks for an answer: write \",\" where 1,234 is a little more than one, \".\" where it is more than a thousand", "Is 1,234 a little more than one, or more than a thousand?");
    } else if decimal.is_none() {
        keys.complain(
            complaints,
            "decimal",
            format!("decimal \"{mark}\" must be \".\" or \",\""),
        );
    }
    decimal
}

/// Reads the name of a file, with places.
pub(super) fn pattern(
    keys: &mut Keys<'_>,
    key: &'static str,
    complaints: &mut Complaints,
) -> Option<Pattern> {
    let text = keys.text(complaints, key)?;
    let pattern = Pattern::read(&text);
    pattern
        .map_err(|message| keys.complain(complaints, key, format!("{key}: {message}")))
        .ok()
}

/// Reads the table of a file that joins a recording; `None` if it has a mistake.
pub(super) fn read(
    source: &Source<'_>,
    name: &str,
    table: &dyn TableLike,
    complaints: &mut Complaints,
) -> Option<Join> {
    let mut keys = Keys::new(source, table, &format!("[join.{name}]"), Some("recording"));
    let file = pattern(&mut keys, "file", complaints);
    let layout = layout(&mut keys, complaints);
    let time = keys.text(complaints, "time");
    let time_unit = keys.text(complaints, "time_unit");
    let offset_s = keys.number(complaints, "offset_s");
    let is_from_start = keys.flag(complaints, "from_start");
    keys.end(complaints);
    if !keys.is_right {
        return None;
    }
    let (Some(file), Some(time), Some(time_unit)) = (file, time, time_unit) else {
        let message = "a joined file needs file (its name), time (a column) and time_unit";
        keys.complain(complaints, "", message);
        return None;
    };
    Some(Join {
        name: name.to_owned(),
        file,
        layout,
        time,
        time_unit,
        offset_s: offset_s.unwrap_or(0.0),
        is_from_start,
    })
}
