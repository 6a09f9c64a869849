//! The text of a proposed map.

use super::card::{ColumnCard, FieldGuess, Guess, WordCard};
use super::word;
use crate::field::RowUse;
use crate::table::Form;

/// Returns a text in quotes, as a TOML string.
fn quoted(text: &str) -> String {
    let escaped = text.chars().map(|c| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

pub(super) fn text(file: &str, guess: &Guess, form: Form, rows: usize) -> String {
    let mut text = header(file, guess, form);
    for field in &guess.fields {
        text += &column_table(field).unwrap_or_default();
    }
    for quantity in &guess.quantities {
        let origin = match &quantity.column {
            Some(column) => format!("column = {}\n", quoted(column)),
            None => format!("value = \"?\"                   # {}\n", quantity.words),
        };
        text += &format!(
            "\n[quantities.{}]\n{origin}{}",
            quantity.name,
            unit_line(quantity.unit.as_deref(), &quantity.units)
        );
    }
    text + &components(guess) + &unmapped(guess, rows)
}

/// Returns the statement about components that are proposed as nothing.
fn components(guess: &Guess) -> String {
    let Some(first) = guess.components.first() else {
        return String::new();
    };
    let listed: Vec<String> = guess.components.iter().map(|name| quoted(name)).collect();
    format!(
        "\n# Letters of axes do not say which force or moment this is on the rig, nor its sign: {}.\n# Say it by the rig's axes, as\n# [columns.drawbar_pull_n]      # positive where the wheel pulls forward\n# formula = \"-f\"\n# [quantities.f]\n# column = {}\n# unit = \"N\"\n",
        listed.join(", "),
        quoted(first)
    )
}

fn header(file: &str, guess: &Guess, form: Form) -> String {
    let name: String = file.chars().filter(|c| !c.is_control()).collect();
    let mut text = format!("# How {name} becomes runs.csv. What is marked with \"?\" must be answered.\n");
    if let Some(sheet) = &guess.sheet {
        text += &format!("sheet = {}\n", quoted(sheet));
    }
    if form != Form::Variables {
        text += &format!(
            "titles = {}                    # line of the titles\n",
            guess.title_line
        );
    }
    if let Some(line) = guess.unit_line {
        text += &format!("units = {line}                     # line of their units\n");
    }
    match guess.decimal.as_deref() {
        Some("?") => {
            text += "decimal = \"?\"                 # \",\" or \".\": is 1,234 a little more than one, or more than a thousand?\n"
        }
        Some(mark) => text += &format!("decimal = \"{mark}\"\n"),
        None => {}
    }
    text
}

/// Returns the table of a column; `None` if the file lacks it and no run needs it.
fn column_table(field: &FieldGuess) -> Option<String> {
    let origin = match (&field.column, &field.formula) {
        (Some(column), _) => format!("column = {}\n", quoted(column)),
        (None, Some(formula)) => format!("formula = {}\n", quoted(formula)),
        (None, None) if field.is_needed => format!(
            "value = \"?\"                   # the same in all rows; or column = \"…\": {}\n",
            field.words
        ),
        (None, None) => return None,
    };
    let mut text = format!("\n[columns.{}]\n{origin}", field.name);
    if field.formula.is_none() && !field.units.is_empty() {
        text += &unit_line(field.unit.as_deref(), &field.units);
    }
    if !field.meanings.is_empty() {
        text += &format!(
            "words = {}   # fit, holdout (never fitted) or skip (no run)\n",
            meanings(&field.meanings)
        );
    }
    Some(text)
}

/// Returns the columns that the map does not use, the first that could mark held-out runs with an example.
fn unmapped(guess: &Guess, rows: usize) -> String {
    let is_mapped = |column: &&ColumnCard| {
        let name = Some(&column.name);
        guess.fields.iter().any(|field| field.column.as_ref() == name)
            || guess
                .quantities
                .iter()
                .any(|quantity| quantity.column.as_ref() == name)
    };
    let rest: Vec<&ColumnCard> = guess.columns.iter().filter(|column| !is_mapped(column)).collect();
    let is_open = guess
        .fields
        .iter()
        .any(|field| field.name == "use" && field.column.is_none());
    let mut text = String::new();
    if let Some(column) = rest
        .iter()
        .find(|column| is_open && word::could_mark(column, rows))
    {
        text += &format!(
            "\n# No column says which runs are held out; the words of one can, as\n# [columns.use]\n# column = {}\n# words = {}   # fit, holdout (never fitted) or skip (no run)\n",
            quoted(&column.name),
            meanings(&column.words)
        );
    }
    let rest: Vec<String> = rest.iter().map(|column| quoted(&column.title)).collect();
    if !rest.is_empty() {
        text += &format!("\n# Kept as notes: {}\n", rest.join(", "));
    }
    text
}

/// Returns the table of words; missing meanings become questions.
fn meanings(words: &[WordCard]) -> String {
    let entry = |card: &WordCard| {
        let means = card.means.map_or("?", RowUse::name);
        format!("{} = \"{means}\"", quoted(&card.word))
    };
    format!("{{ {} }}", words.iter().map(entry).collect::<Vec<_>>().join(", "))
}

fn unit_line(unit: Option<&str>, units: &[String]) -> String {
    match unit {
        Some(unit) => format!("unit = {}\n", quoted(unit)),
        None => format!(
            "unit = \"?\"                    # the file does not state it: {}\n",
            units.join(", ")
        ),
    }
}
