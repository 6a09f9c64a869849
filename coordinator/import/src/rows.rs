//! A table with one run in each row.

use crate::binding::{Above, Binding, is_text};
use crate::complaint::Complaints;
use crate::rule;
use crate::run::{Run, noted, notes_of, repeated, shown};
use crate::table::Row;
use crate::title::Titled;

/// The run of every row.
pub(crate) fn runs(
    titled: &Titled,
    rows: &[&Row],
    binding: &Binding,
    complaints: &mut Complaints,
) -> Vec<Run> {
    let notes = noted(titled, &binding.mapped);
    let mut above = Above::default();
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
                    .map(|text| rule::of_text(field, &text))
            } else {
                let value = binding.value(output, &numbers);
                value.map(|value| rule::of_number(field, value).map(|()| shown(value)))
            };
            match text {
                Some(Ok(text)) if field.name == "run" => run.name = text,
                Some(Ok(text)) => {
                    run.cells.insert(field.name.clone(), text);
                }
                Some(Err(message)) => complaints.add_cell(binding.complaint(titled, row, output, message)),
                // A cell that cannot be read has its own complaint.
                None if (field.is_needed || field.name == "run")
                    && !complaints.is_said(row.line, &field.name) =>
                {
                    let message = format!(
                        "{} is blank: every run needs it; `fill_down = true` takes it from the row above",
                        field.words
                    );
                    complaints.add_cell(binding.complaint(titled, row, output, message));
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
