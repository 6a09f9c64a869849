//! Rows that summarise runs: means, totals.

use crate::binding::Binding;
use crate::complaint::{Complaint, Complaints, Fix};
use crate::table::{Cell, Row};
use crate::title::Titled;

/// First words of a row of means or totals, in lower case.
const WORDS: [&str; 24] = [
    "mean",
    "means",
    "average",
    "averages",
    "avg",
    "median",
    "total",
    "totals",
    "sum",
    "mittel",
    "mittelwert",
    "mittelwerte",
    "durchschnitt",
    "summe",
    "gesamt",
    "standardabweichung",
    "stabw",
    "streuung",
    "varianz",
    "variance",
    "stddev",
    "std",
    "ø",
    "∅",
];
/// Further first words, which count only if nothing follows, because a remark may begin with the same word.
const WHOLE: [&str; 8] = [
    "min",
    "max",
    "minimum",
    "maximum",
    "sd",
    "sigma",
    "standard deviation",
    "std. dev.",
];

/// Returns the text that marks a row of means or totals: the first text in it.
fn label(row: &Row) -> Option<&str> {
    let text = row.cells.iter().find_map(|cell| match cell {
        Cell::Text(text) if !crate::number::is_number(text) => Some(text.as_str()),
        _ => None,
    })?;
    let plain = text.trim_end_matches([':', '.']).to_lowercase();
    let first = plain
        .split(|c: char| c.is_whitespace() || ":.,;(=".contains(c))
        .next();
    let is_label = first.is_some_and(|first| WORDS.contains(&first)) || WHOLE.contains(&plain.as_str());
    is_label.then_some(text)
}

/// Returns the rows that can be runs. A row marked as means or totals is a mistake if it lacks a value that every run needs; otherwise it
/// counts as a run, with a remark.
pub(crate) fn without<'a>(
    titled: &Titled,
    rows: Vec<&'a Row>,
    binding: &Binding,
    remarks: &mut Vec<String>,
    complaints: &mut Complaints,
) -> Vec<&'a Row> {
    let mut kept = Vec::with_capacity(rows.len());
    for row in rows {
        match label(row) {
            Some(label) if binding.lacks(row) => {
                let plain = format!("the row \"{label}\" is no run");
                complaints.add_cell(Complaint {
                    line: Some(row.line),
                    plain: Some(plain.clone()),
                    fix: Some(Fix::Skip),
                    row: row.beginning(),
                    ..titled
                        .table
                        .complaint(format!("{plain}: skip it with `skip = [{}]` in the map", row.line))
                });
                continue;
            }
            Some(label) => remarks.push(format!(
                "{} (\"{label}\") is taken as a run, because it has all that a run needs; if it is none, `skip = [{}]` in the map leaves it out",
                titled.table.place(row.line),
                row.line
            )),
            None => {}
        }
        kept.push(row);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_means_is_told_by_its_first_text() {
        let labelled = |cells: &[&str]| {
            let cells = cells.iter().map(|text| Cell::from_text(text)).collect();
            label(&Row { line: 1, cells }).map(str::to_owned)
        };
        for first in [
            "Mittelwert",
            "Mittelwert V1–V9",
            "mean",
            "Mean:",
            "Ø",
            "Max",
            "Standard deviation",
        ] {
            assert_eq!(labelled(&["", "12,5", first, "x"]).as_deref(), Some(first));
        }
        for first in ["V1", "meander", "max. load reached", "Sand"] {
            assert_eq!(labelled(&[first, "12,5", "Mittelwert"]), None, "{first}");
        }
    }
}
