//! A map bound to a table: the numbers and texts of each row.

use std::collections::{BTreeMap, BTreeSet};

use formula::expression::Expression;
use formula::unit::Unit as Dimension;

use super::maker::{Maker, dimension};
use super::source::{From, Input, Output, Source};
use crate::complaint::{Complaint, Complaints};
use crate::field::{Field, RowUse};
use crate::map::{Entry, Map, Origin};
use crate::number;
use crate::table::{Cell, Row, spaced};
use crate::title::Titled;

/// A map bound to a table.
#[derive(Debug)]
pub(crate) struct Binding {
    inputs: Vec<Input>,
    pub(crate) outputs: Vec<Output>,
    /// The columns that have the names and units of runs.csv.
    pub(crate) mapped: BTreeSet<usize>,
    missing: BTreeSet<String>,
    /// 1 during a run of a recording that is told by a condition.
    condition: Option<Expression>,
}

/// The cells above a row, by which blank cells may be filled.
#[derive(Debug, Default)]
pub(crate) struct Above(Vec<Option<Cell>>);

impl Above {
    fn cell<'a>(&'a mut self, row: &'a Row, column: usize, fills_down: bool) -> &'a Cell {
        let cell = row.cell(column);
        if !fills_down {
            return cell;
        }
        if self.0.len() <= column {
            self.0.resize(column + 1, None);
        }
        if !cell.is_blank() {
            self.0[column] = Some(cell.clone());
        }
        self.0[column].as_ref().unwrap_or(&Cell::Blank)
    }
}

impl Binding {
    pub(crate) fn new(
        (map_file, map): (&str, &Map),
        titled: &Titled,
        fields: &[Field],
        remarks: &mut Vec<String>,
        complaints: &mut Complaints,
    ) -> Self {
        let mut maker = Maker {
            map,
            map_file,
            titled,
            fields,
            remarks,
            complaints,
        };
        let mut binding = Binding {
            inputs: Vec::new(),
            outputs: Vec::new(),
            mapped: BTreeSet::new(),
            missing: map.missing.clone(),
            condition: None,
        };
        let mut names = binding.bind_quantities(map, &mut maker);
        let by_name = |field: &Field| map.columns.iter().find(|entry| entry.name == field.name);
        let mut formulas = Vec::new();
        for (field, entry) in fields.iter().filter_map(|field| Some((field, by_name(field)?))) {
            let source = match (&entry.origin, field.quantity()) {
                (Origin::Formula(text), Some(quantity)) => {
                    formulas.push((field, entry, text, quantity));
                    None
                }
                (Origin::Formula(_), None) => {
                    let message = format!("{} is no quantity: a formula cannot give it", field.name);
                    maker.complain(entry, message);
                    None
                }
                (_, Some(quantity)) => maker.input(entry, Some(quantity)).map(|(input, _)| {
                    names.push((field.name.clone(), dimension(quantity)));
                    binding.inputs.push(input);
                    Source::Input(binding.inputs.len() - 1)
                }),
                (_, None) => maker.text(entry).map(Source::Text),
            };
            if let Some(source) = source {
                binding.bind(field, entry, source, titled);
            }
        }
        binding.condition = maker.condition(&names);
        for (field, entry, text, quantity) in formulas {
            if let Some(expression) = maker.formula(entry, text, quantity, &names) {
                binding.outputs.push(Output {
                    field: field.clone(),
                    source: Source::Formula(expression),
                    words: BTreeMap::new(),
                });
            }
        }
        let place = |output: &Output| fields.iter().position(|field| field.name == output.field.name);
        binding.outputs.sort_by_key(place);
        maker.settle_decimals(&mut binding.inputs);
        binding
    }

    /// Returns the names of the quantities in formulas, with their dimensions.
    fn bind_quantities(&mut self, map: &Map, maker: &mut Maker) -> Vec<(String, Dimension)> {
        let mut names = Vec::new();
        for entry in &map.quantities {
            if let Some((input, dimension)) = maker.quantity(entry) {
                names.push((entry.name.clone(), dimension));
                self.inputs.push(input);
            }
        }
        names
    }

    fn bind(&mut self, field: &Field, entry: &Entry, source: Source, titled: &Titled) {
        if let Origin::Column(title) = &entry.origin
            && let Ok(column) = titled.column(title)
        {
            self.mapped.insert(column);
        }
        self.outputs.push(Output {
            field: field.clone(),
            source,
            words: entry.words.clone(),
        });
    }

    /// Returns the numbers of a row in SI units, in the order of the names of formulas; `None` if the cell is blank.
    pub(crate) fn numbers(
        &self,
        titled: &Titled,
        row: &Row,
        above: &mut Above,
        complaints: &mut Complaints,
    ) -> Vec<Option<f64>> {
        let read = |input: &Input| match &input.from {
            From::Fixed(_) => Some(input.fixed),
            From::Column {
                column,
                fills_down,
                with,
            } => {
                let cell = above.cell(row, *column, *fills_down);
                let number = match cell {
                    Cell::Blank => None,
                    Cell::Number(value) if value.is_finite() => Some(Ok(*value)),
                    Cell::Number(value) => Some(Err(format!("{value} is no finite number"))),
                    Cell::Text(text) if self.missing.contains(text) => None,
                    Cell::Text(text) => with.writing.map(|writing| number::read(text, writing)),
                    Cell::NoResult => Some(Err("the formula of this cell has no stored result: open the file in its program, let it compute, and save it again".into())),
                };
                match number? {
                    Ok(value) => Some((value - with.at_rest) * with.si),
                    Err(message) => {
                        complaints.add_cell(cell_complaint(titled, row, *column, &input.name, message));
                        None
                    }
                }
            }
        };
        self.inputs.iter().map(read).collect()
    }

    /// Returns the text of a row for a column of names; `None` if the cell is blank.
    pub(crate) fn text(&self, output: &Output, row: &Row, above: &mut Above) -> Option<String> {
        let Source::Text(from) = &output.source else {
            return None;
        };
        let From::Column {
            column, fills_down, ..
        } = from
        else {
            return from.fixed();
        };
        let text = above.cell(row, *column, *fills_down).shown();
        let text = (!text.is_empty() && !self.missing.contains(&text)).then_some(text);
        let word = text.as_deref().map(spaced).unwrap_or_default();
        match output.words.get(&word) {
            Some(meaning) => Some(meaning.name().to_owned()),
            None => text,
        }
    }

    /// Returns the rows of runs, and the lines that a word marks as no runs.
    pub(crate) fn chosen<'a>(&self, rows: Vec<&'a Row>) -> (Vec<&'a Row>, Vec<usize>) {
        let leaves_out = |output: &&Output| output.words.values().any(|word| *word == RowUse::Skip);
        let Some(output) = self.outputs.iter().find(leaves_out) else {
            return (rows, Vec::new());
        };
        let mut above = Above::default();
        let mut is_run =
            |row: &&Row| self.text(output, row, &mut above).as_deref() != Some(RowUse::Skip.name());
        let (kept, left_out): (Vec<&Row>, Vec<&Row>) = rows.into_iter().partition(|row| is_run(row));
        (kept, left_out.iter().map(|row| row.line).collect())
    }

    /// Returns whether a row lacks a value that every run needs: its cell is blank, or has no number where one is needed.
    pub(crate) fn lacks(&self, row: &Row) -> bool {
        let needed = self.outputs.iter().filter(|output| output.field.is_needed);
        let lacks_input = |input: &usize| {
            let Some(column) = self.inputs.get(*input).and_then(Input::column) else {
                return false;
            };
            let cell = row.cell(column);
            self.is_blank(cell) || matches!(cell, Cell::Text(text) if !number::is_number(text))
        };
        needed.into_iter().any(|output| match &output.source {
            Source::Input(input) => lacks_input(input),
            Source::Formula(expression) => expression.used().iter().any(lacks_input),
            Source::Text(from) => from
                .column()
                .is_some_and(|column| self.is_blank(row.cell(column))),
        })
    }

    fn is_blank(&self, cell: &Cell) -> bool {
        match cell {
            Cell::Text(text) => self.missing.contains(text),
            cell => cell.is_blank(),
        }
    }

    /// Returns the name in the map and the column of the first blank cell that a column of runs.csv needs.
    pub(crate) fn blank<'a>(&'a self, output: &'a Output, row: &Row) -> Option<(&'a str, usize)> {
        let blank_input = |input: &usize| {
            let input = self.inputs.get(*input)?;
            let column = input.column().filter(|column| self.is_blank(row.cell(*column)))?;
            Some((input.name.as_str(), column))
        };
        match &output.source {
            Source::Input(input) => blank_input(input),
            Source::Formula(expression) => expression.used().iter().find_map(blank_input),
            Source::Text(from) => Some((output.field.name.as_str(), from.column()?)),
        }
    }

    /// Returns the value of a column of runs.csv in its unit, from the numbers of a row; `None` if a needed one is blank.
    pub(crate) fn value(&self, output: &Output, numbers: &[Option<f64>]) -> Option<f64> {
        let si = match &output.source {
            Source::Input(input) => numbers.get(*input).copied().flatten()?,
            Source::Formula(expression) => computed(expression, numbers)?,
            Source::Text(_) => return None,
        };
        Some(si / output.field.si_per_unit())
    }

    /// Returns whether a row with these numbers lies within a run; a row with a blank that the condition needs does not.
    pub(crate) fn is_within_a_run(&self, numbers: &[Option<f64>]) -> bool {
        let value = self
            .condition
            .as_ref()
            .map(|condition| computed(condition, numbers));
        value.is_none_or(|value| value.is_some_and(|value| value > 0.5))
    }

    /// Returns a complaint about a row's value for a column of runs.csv, at the cell that gives it.
    pub(crate) fn complaint(
        &self,
        titled: &Titled,
        row: &Row,
        output: &Output,
        message: String,
    ) -> Complaint {
        let column = match &output.source {
            Source::Input(input) => self.inputs.get(*input).and_then(Input::column),
            Source::Text(from) => from.column(),
            Source::Formula(_) => None,
        };
        match column {
            Some(column) => cell_complaint(titled, row, column, &output.field.name, message),
            None => Complaint {
                line: Some(row.line),
                field: Some(output.field.name.clone()),
                ..titled.table.complaint(message)
            },
        }
    }
}

/// Returns the value of a formula; `None` if a needed number is blank.
fn computed(expression: &Expression, numbers: &[Option<f64>]) -> Option<f64> {
    let is_there = |place: &usize| numbers.get(*place).is_some_and(Option::is_some);
    if !expression.used().iter().all(is_there) {
        return None;
    }
    let values: Vec<f64> = numbers.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    Some(expression.value(&values))
}

pub(crate) fn cell_complaint(
    titled: &Titled,
    row: &Row,
    column: usize,
    field: &str,
    message: String,
) -> Complaint {
    Complaint {
        column: titled.titles.get(column).map(|title| title.text.clone()),
        field: Some(field.to_owned()),
        ..titled.table.complaint_at(row.line, column, message)
    }
}
