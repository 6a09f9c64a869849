//! The variables of a MATLAB file, as a table with their names as titles.

use super::source_file::Hints;
use crate::complaint::Complaint;
use crate::table::{Cell, Form, Row, Table};

/// A MATLAB value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    /// A matrix in column order.
    Numbers {
        rows: usize,
        columns: usize,
        values: Vec<f64>,
    },
    /// A list of texts: a char matrix, or a cell array of texts.
    Texts(Vec<String>),
    /// A struct: values by the names of its fields; the elements of a struct array are one list.
    Fields(Vec<(String, Vec<Value>)>),
    /// A value that does not fit into a table, in words.
    Other(&'static str),
}

pub(super) type Variables = Vec<(String, Value)>;

/// A column with its title.
type Column = (String, Vec<Cell>);

fn columns(name: &str, value: &Value) -> Result<Vec<Column>, String> {
    let number = |value: &f64| {
        if value.is_nan() {
            Cell::Blank
        } else {
            Cell::Number(*value)
        }
    };
    match value {
        Value::Numbers {
            rows,
            columns,
            values,
        } if *rows == 1 || *columns == 1 => Ok(vec![(name.to_owned(), values.iter().map(number).collect())]),
        Value::Numbers { rows, values, .. } => {
            let column = |(k, part): (usize, &[f64])| {
                (format!("{name}(:,{})", k + 1), part.iter().map(number).collect())
            };
            Ok(values.chunks((*rows).max(1)).enumerate().map(column).collect())
        }
        Value::Texts(texts) => Ok(vec![(
            name.to_owned(),
            texts.iter().map(|text| Cell::from_text(text)).collect(),
        )]),
        Value::Fields(_) => Err("a struct within a struct".into()),
        Value::Other(words) => Err((*words).to_owned()),
    }
}

/// Returns the columns of a struct array: an element is a row.
fn columns_of_elements(field: &str, values: &[Value]) -> Result<Column, String> {
    let cell = |value: &Value| match value {
        Value::Numbers { values, .. } if values.is_empty() => Ok(Cell::Blank),
        Value::Numbers { values, .. } if values.len() == 1 => Ok(Cell::Number(values[0])),
        Value::Texts(texts) if texts.len() <= 1 => {
            Ok(texts.first().map_or(Cell::Blank, |text| Cell::from_text(text)))
        }
        Value::Other(words) => Err((*words).to_owned()),
        _ => Err("a list in an element of a struct array".to_owned()),
    };
    Ok((
        field.to_owned(),
        values.iter().map(cell).collect::<Result<_, _>>()?,
    ))
}

/// Columns of a table, by the name of the struct that contains them; `""` outside of structs.
struct Group {
    name: String,
    columns: Vec<Column>,
    left_out: Vec<String>,
}

impl Group {
    fn new(name: &str) -> Self {
        Group {
            name: name.to_owned(),
            columns: Vec::new(),
            left_out: Vec::new(),
        }
    }

    fn take(&mut self, name: &str, columns: Result<Vec<Column>, String>) {
        match columns {
            Ok(columns) => self.columns.extend(columns),
            Err(words) => self.left_out.push(format!("{name} ({words})")),
        }
    }

    fn length(&self) -> usize {
        self.columns
            .iter()
            .map(|(_, cells)| cells.len())
            .max()
            .unwrap_or(0)
    }
}

fn groups(variables: &Variables) -> Vec<Group> {
    let mut top = Group::new("");
    let mut all = Vec::new();
    for (name, value) in variables {
        let Value::Fields(fields) = value else {
            top.take(name, columns(name, value));
            continue;
        };
        let mut group = Group::new(name);
        for (field, values) in fields {
            match values.as_slice() {
                [one] => group.take(field, columns(field, one)),
                many => group.take(field, columns_of_elements(field, many).map(|column| vec![column])),
            }
        }
        all.push(group);
    }
    all.insert(0, top);
    all.retain(|group| !group.columns.is_empty());
    all
}

/// Returns the index of the group that is read.
fn chosen(groups: &[Group], table: &Table, hints: &Hints) -> Result<usize, Box<Complaint>> {
    if let Some(stated) = &hints.sheet {
        let position = groups.iter().position(|group| group.name == *stated);
        return position.ok_or_else(|| {
            let names = groups.iter().map(|group| group.name.as_str());
            table.refusal(shared::file::unknown_word("struct", stated, names))
        });
    }
    let long = groups.iter().filter(|group| group.length() > 1).count();
    if long > 1 && !hints.takes_largest {
        let names: Vec<String> = table.sheets.iter().map(|name| format!("\"{name}\"")).collect();
        let message = format!(
            "several structs have columns (\"\" is outside of all): state `sheet = ` in the map, one of {}",
            names.join(", ")
        );
        return Err(table.refusal(message));
    }
    let largest = (0..groups.len())
        .rev()
        .max_by_key(|&k| (groups[k].length().min(2), groups[k].columns.len()));
    largest.ok_or_else(|| table.refusal("the file has no variable with numbers or texts: save the columns as vectors, or a struct of vectors (a MATLAB table as table2struct(t, 'ToScalar', true))"))
}

/// Returns a row of the table; a scalar is repeated.
fn row(columns: &[Column], index: usize) -> Row {
    let cell = |(_, cells): &Column| {
        cells
            .get(index)
            .or(cells.first().filter(|_| cells.len() == 1))
            .cloned()
            .unwrap_or(Cell::Blank)
    };
    Row {
        line: index + 1,
        cells: columns.iter().map(cell).collect(),
    }
}

/// Returns the table of variables of equal length; a scalar counts for every row.
pub(super) fn table(
    file: &str,
    variables: Result<Variables, String>,
    hints: &Hints,
) -> Result<Table, Box<Complaint>> {
    let mut table = Table {
        file: file.to_owned(),
        sheet: None,
        sheets: Vec::new(),
        form: Form::Variables,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let mut groups = groups(&variables.map_err(|e| table.complaint(e))?);
    table.sheets = groups.iter().map(|group| group.name.clone()).collect();
    let mut group = groups.swap_remove(chosen(&groups, &table, hints)?);
    table.sheet = (!group.name.is_empty()).then(|| group.name.clone());
    // The length of most columns, the longer of two; scalars are not counted.
    let lengths = |length: usize| {
        group
            .columns
            .iter()
            .filter(|(_, cells)| cells.len() == length)
            .count()
    };
    let rows = group
        .columns
        .iter()
        .map(|(_, cells)| cells.len())
        .filter(|&n| n > 1)
        .max_by_key(|&n| (lengths(n), n))
        .unwrap_or(1);
    let (fitting, misfits): (Vec<Column>, Vec<Column>) = group
        .columns
        .into_iter()
        .partition(|(_, cells)| cells.len() == rows || cells.len() == 1);
    group.left_out.extend(
        misfits
            .iter()
            .map(|(name, cells)| format!("{name} ({} values where the others have {rows})", cells.len())),
    );
    if !group.left_out.is_empty() {
        table.remarks.push(format!(
            "left out, no columns of this table: {}",
            group.left_out.join(", ")
        ));
    }
    table.rows.push(Row {
        line: 0,
        cells: fitting.iter().map(|(name, _)| Cell::Text(name.clone())).collect(),
    });
    table.rows.extend((0..rows).map(|index| row(&fitting, index)));
    Ok(table)
}
