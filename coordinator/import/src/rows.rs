//! A table with one run in each row.

use std::collections::BTreeMap;

use crate::binding::{Above, Binding, Output, cell_complaint, is_text};
use crate::complaint::{Complaint, Complaints, Fix};
use crate::rule;
use crate::run::{Run, noted, notes_of, repeated, shown};
use crate::table::Row;
use crate::title::Titled;

pub(crate) fn runs(
    titled: &Titled,
    rows: &[&Row],
    binding: &Binding,
    complaints: &mut Complaints,
) -> Vec<Run> {
    let notes = noted(titled, &binding.mapped);
    let mut above = Above::default();
    let mut blanks = Blanks {
        titled,
        rows,
        binding,
        blocks: BTreeMap::new(),
    };
    let mut runs = Vec::with_capacity(rows.len());
    for (number, row) in rows.iter().enumerate() {
        let numbers = binding.numbers(titled, row, &mut above, complaints);
        let mut run = Run {
            line: row.line,
            name: format!("r{}", number + 1),
            notes: notes_of(row, &notes),
            ..Run::default()
        };
        for output in &binding.outputs {
            let field = &output.field;
            let text = if is_text(output) {
                binding
                    .text(output, row, &mut above)
                    .map(|text| rule::check_text(field, &text))
            } else {
                let value = binding.value(output, &numbers);
                value.map(|value| rule::check_number(field, value).map(|()| shown(value)))
            };
            match text {
                Some(Ok(text)) if field.name == "run" => run.name = text,
                Some(Ok(text)) => {
                    run.cells.insert(field.name.clone(), text);
                }
                Some(Err(message)) => complaints.add_cell(binding.complaint(titled, row, output, message)),
                // A cell that cannot be read has a complaint already.
                None if (field.is_needed || field.name == "run")
                    && !complaints.is_said(row.line, &field.name) =>
                {
                    if let Some(complaint) = blanks.complaint(output, row) {
                        complaints.add_cell(complaint);
                    }
                }
                None => {}
            }
        }
        runs.push(run);
    }
    for complaint in repeated(titled, &runs) {
        complaints.add_cell(complaint);
    }
    runs
}

/// The treatment of blank cells that every run needs.
struct Blanks<'a> {
    titled: &'a Titled,
    rows: &'a [&'a Row],
    binding: &'a Binding,
    /// For each column, the first line from which a blank cell may repeat the cell above; `None` if it never may.
    blocks: BTreeMap<usize, Option<usize>>,
}

impl Blanks<'_> {
    /// Returns the complaint about a missing value of a row; `None` if the reason is a cell that cannot be read.
    fn complaint(&mut self, output: &Output, row: &Row) -> Option<Complaint> {
        let field = &output.field;
        let (name, column) = self.binding.blank(output, row)?;
        let because = if name == field.name {
            String::new()
        } else {
            format!(", because {name} is")
        };
        let plain = format!("{} is blank{because}: every run needs it", field.words);
        // Names of runs differ, so none comes from the row above.
        let (fix, advice) = if field.name != "run" && self.is_of_a_block(column, row) {
            (
                Fix::FillDown,
                "`fill_down = true` takes it from the row above".to_owned(),
            )
        } else {
            (
                Fix::Skip,
                format!("fill it in, or leave the row out with `skip = [{}]`", row.line),
            )
        };
        let message = format!("{plain}; {advice}");
        Some(Complaint {
            plain: Some(plain),
            fix: Some(fix),
            row: match fix {
                Fix::Skip => row.beginning(),
                Fix::FillDown => Vec::new(),
            },
            ..cell_complaint(self.titled, row, column, name, message)
        })
    }

    /// Returns whether a blank cell may repeat the cell above. A column that states its values once for a block of rows has at least a
    /// third of its cells blank, and the first one filled.
    fn is_of_a_block(&mut self, column: usize, row: &Row) -> bool {
        let rows = self.rows;
        let begin = self.blocks.entry(column).or_insert_with(|| {
            let mut filled = rows.iter().filter(|row| !row.cell(column).is_blank());
            let first = filled.next()?.line;
            (3 * (1 + filled.count()) <= 2 * rows.len()).then_some(first)
        });
        begin.is_some_and(|first| first < row.line)
    }
}
