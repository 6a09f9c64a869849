//! The conversion of a file by its map to runs.csv, with every mistake at once.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use crate::binding::Binding;
use crate::complaint::{Complaint, Complaints};
use crate::field::{Field, fields};
use crate::files::{self, Beside, Files, stem};
use crate::join;
use crate::map::{self, Map, Origin};
use crate::pattern::{Names, Pattern};
use crate::read::SourceFile;
use crate::recording::{Knife, cut};
use crate::rows;
use crate::run::{Run, noted, notes_csv, runs_csv};
use crate::summary;
use crate::table::Row;
use crate::title::Titled;
use crate::zero;

/// Maximum number of runs of an import.
const MAX_RUNS: usize = 10_000;
/// Number of files with mistakes after which no more are read.
const MAX_WRONG: usize = 10;

/// The result of an import.
#[derive(Debug, Clone, Default, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Converted {
    /// The text of runs.csv; null where there are complaints.
    pub runs: Option<String>,
    /// The columns of the file that runs.csv does not have, by run, as CSV; null without any.
    pub notes: Option<String>,
    /// The texts of the histories by their names in runs.csv.
    pub histories: BTreeMap<String, String>,
    /// Number of runs.
    pub run_count: usize,
    /// Remarks for the user: detected properties of the file, omissions, and readings that differ from the file.
    pub remarks: Vec<String>,
    /// All mistakes.
    pub complaints: Vec<Complaint>,
}

/// Converts one file by a map; [`convert_all`] with no file beside it.
///
/// `map` is the name and the text of the map; `stem` is the prefix of the names of histories, equal to that of runs.csv. Checked by
/// `tests/mistakes.rs`.
pub fn convert(source: &SourceFile<'_>, map: (&str, &str), stem: &str) -> Converted {
    let names = [source.name.to_owned()];
    let open = |name: &str| {
        let is_it = name == source.name;
        let bytes = is_it.then_some(Cow::Borrowed(source.bytes));
        bytes.ok_or_else(|| "there is no such file".to_owned())
    };
    let files = Files {
        names: &names,
        open: &open,
        is_own: source.is_own,
    };
    convert_all(files, map, stem)
}

/// Converts files by a map, one after the other: the runs of all are one runs.csv.
///
/// Nothing is written if there is a mistake. Mistakes of the map do not hide those of cells that can be judged without it. Several files must
/// be recordings. Checked by `tests/raw.rs`.
pub fn convert_all(files: Files<'_>, (map_file, map_text): (&str, &str), stem: &str) -> Converted {
    let mut complaints = Complaints::default();
    let mut converted = Converted::default();
    let fields = fields();
    let map = map::read(map_file, map_text, &fields, &mut complaints);
    let count = files.names.len();
    let refusal = match &map.recording {
        None if count > 1 => Some(format!(
            "{count} files must be recordings: the map needs [recording]; a table has all its runs in one file"
        )),
        _ if count > MAX_RUNS => Some(format!("{count} files must be at most {MAX_RUNS}")),
        _ => None,
    };
    if let Some(message) = refusal {
        complaints.add(Complaint {
            file: map_file.to_owned(),
            message,
            ..Complaint::default()
        });
        converted.complaints = complaints.into_all();
        return converted;
    }
    let mut all = Runs::default();
    let mut remarks: Vec<(String, Vec<&str>)> = Vec::new();
    for (place, file) in files.names.iter().enumerate() {
        let before = complaints.len();
        let mut said = Vec::new();
        all.take(
            file,
            (files, &fields),
            (map_file, &map),
            stem,
            &mut said,
            &mut complaints,
        );
        for remark in said {
            match remarks.iter_mut().find(|(known, _)| *known == remark) {
                Some((_, names)) => names.push(file),
                None => remarks.push((remark, vec![file])),
            }
        }
        all.wrong += usize::from(complaints.len() > before);
        let rest = files.names.len() - place - 1;
        if all.wrong == MAX_WRONG && rest > 0 {
            let message = format!("{rest} more files are not read, since {MAX_WRONG} have mistakes");
            complaints.add(Complaint {
                file: file.clone(),
                message,
                ..Complaint::default()
            });
            break;
        }
    }
    check_names(&all.runs, &mut complaints);
    converted.run_count = all.runs.len();
    let runs: Vec<Run> = all.runs.into_iter().map(|(_, run)| run).collect();
    if runs.len() > MAX_RUNS {
        complaints.add(Complaint {
            file: files.names.first().cloned().unwrap_or_default(),
            message: format!(
                "{} runs must be at most {MAX_RUNS}; for a recording of several runs the map needs [recording]",
                runs.len()
            ),
            ..Complaint::default()
        });
    }
    converted.remarks = remarks
        .into_iter()
        .map(|(remark, names)| told(remark, &names, files.names))
        .collect();
    converted.complaints = complaints.into_all();
    if converted.complaints.is_empty() {
        converted.runs = Some(runs_csv(&runs, fields.iter().map(|field| field.name.clone())));
        converted.notes = all.notes;
        converted.histories = all.histories;
    }
    converted
}

/// Returns a remark with the files that it is about, if it is not about all.
fn told(remark: String, names: &[&str], all: &[String]) -> String {
    match names {
        _ if names.len() == all.len() => remark,
        [one] => format!("{one}: {remark}"),
        [first, ..] => format!("{first} and {} more files: {remark}", names.len() - 1),
        [] => remark,
    }
}

/// Complains about runs of several files that have the same name.
fn check_names(runs: &[(String, Run)], complaints: &mut Complaints) {
    let mut first: BTreeMap<&str, &str> = BTreeMap::new();
    for (file, run) in runs {
        let other = *first.entry(&run.name).or_insert(file);
        if other != file {
            complaints.add_cell(Complaint {
                file: file.clone(),
                field: Some("run".into()),
                message: format!(
                    "run \"{}\" is also one of {other}: give each a name of its own by [columns.run]",
                    run.name
                ),
                ..Complaint::default()
            });
        }
    }
}

/// The runs of the files that have been converted.
#[derive(Default)]
struct Runs {
    /// Each run with the name of its file.
    runs: Vec<(String, Run)>,
    notes: Option<String>,
    histories: BTreeMap<String, String>,
    /// Number of files with mistakes.
    wrong: usize,
}

impl Runs {
    /// Takes the runs of one more file.
    fn take(
        &mut self,
        file: &str,
        (files, fields): (Files<'_>, &[Field]),
        (map_file, map): (&str, &Map),
        stem: &str,
        remarks: &mut Vec<String>,
        complaints: &mut Complaints,
    ) {
        let wrong = |message: String| Complaint {
            file: file.to_owned(),
            message,
            ..Complaint::default()
        };
        let names = match names_of(file, map) {
            Ok(names) => names,
            Err(message) => return complaints.add(wrong(message)),
        };
        let mut titled = match files.read(file, &map.layout, fields) {
            Ok(titled) => titled,
            Err(complaint) => return complaints.add(*complaint),
        };
        let mut map = map.clone();
        let mut beside = Beside::new(files, fields, file, names);
        let mut mistakes = fill(&mut map, &beside.names);
        mistakes.extend(zero::settle(&titled, &mut map, &mut beside));
        mistakes.extend(join::join(&mut titled, &mut map, &mut beside, remarks));
        for complaint in mistakes {
            // A mistake of the map has no file.
            complaints.add(match complaint.file.is_empty() {
                true => wrong(complaint.message.clone()),
                false => complaint,
            });
        }
        let several = files.names.len() > 1;
        self.judge(
            &titled,
            (map_file, &map),
            fields,
            (stem, several),
            remarks,
            complaints,
        );
    }
}

/// Returns what the name of a file says: the places of the map's pattern, and the name without its ending.
fn names_of(file: &str, map: &Map) -> Result<Names, String> {
    let mut names = match &map.file {
        Some(pattern) => pattern
            .matched(file)?
            .ok_or_else(|| format!("the name does not fit `file = \"{}\"` of the map", pattern.text()))?,
        None => Names::new(),
    };
    names
        .entry("stem".into())
        .or_insert_with(|| stem(file).to_owned());
    Ok(names)
}

/// Fills the places in the values of a map; returns the mistakes.
fn fill(map: &mut Map, names: &Names) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    for entry in map.entries_mut() {
        let Origin::Value(text) = &entry.origin else {
            continue;
        };
        if !text.contains(['{', '}']) {
            continue;
        }
        match Pattern::read(text).and_then(|pattern| pattern.filled(names)) {
            Ok(text) => entry.origin = Origin::Value(text),
            Err(message) => complaints.push(Complaint {
                field: Some(entry.name.clone()),
                message: format!("{}: {message}", entry.name),
                ..Complaint::default()
            }),
        }
    }
    complaints
}

/// Returns those of the names of files that the map's pattern means; `None` if the map has no pattern.
pub fn files_of(map_text: &str, names: &[String]) -> Option<Vec<String>> {
    let map = map::read("", map_text, &fields(), &mut Complaints::default());
    let pattern = map.file?;
    // A name that fits in two ways is meant, and refused when it is read.
    let is_meant = |name: &&String| !matches!(pattern.matched(name), Ok(None));
    Some(names.iter().filter(is_meant).cloned().collect())
}

impl Runs {
    /// Binds the map to a file, and adds its runs.
    fn judge(
        &mut self,
        titled: &Titled,
        (map_file, map): (&str, &Map),
        fields: &[Field],
        (stem, is_one_of_several): (&str, bool),
        remarks: &mut Vec<String>,
        complaints: &mut Complaints,
    ) {
        remarks.extend(titled.table.remarks.iter().cloned());
        complain_of_missing(titled, (map_file, map), fields, complaints);
        let rows = chosen(titled, (map_file, map), remarks, complaints);
        let binding = Binding::new((map_file, map), titled, fields, remarks, complaints);
        let (mut rows, left_out) = binding.chosen(rows);
        if !left_out.is_empty() {
            remarks.push(format!(
                "left out, because a word of theirs means skip: {}",
                lines(left_out.into_iter())
            ));
        }
        if map.recording.is_none() {
            rows = summary::without(titled, rows, &binding, remarks, complaints);
        }
        check_width(titled, &rows, complaints);
        let runs = match &map.recording {
            Some(recording) => {
                let knife = Knife {
                    titled,
                    binding: &binding,
                    recording,
                    map_file,
                    decimal: map.layout.decimal,
                    stem,
                    file_run: files::stem(&titled.table.file),
                    is_one_of_several,
                };
                cut(&knife, &rows, &mut self.histories, remarks, complaints)
            }
            None => rows::runs(titled, &rows, &binding, complaints),
        };
        if runs.is_empty() && map.recording.is_none() {
            complaints.add(titled.table.complaint("there is no row of data below the titles"));
        }
        self.keep_notes(titled, map, &binding, &runs, remarks);
        let file = &titled.table.file;
        self.runs.extend(runs.into_iter().map(|run| (file.clone(), run)));
        if map.recording.is_none() && !map.columns.iter().any(|entry| entry.name == "run") {
            remarks.push("the runs are numbered, r1 and so on: the map has no [columns.run]".into());
        }
    }

    /// Keeps the columns that runs.csv does not have as notes; those of a recording are only remarked.
    fn keep_notes(
        &mut self,
        titled: &Titled,
        map: &Map,
        binding: &Binding,
        runs: &[Run],
        remarks: &mut Vec<String>,
    ) {
        let kept = noted(titled, &binding.mapped);
        if kept.is_empty() {
            return;
        }
        let titles: Vec<String> = kept
            .iter()
            .map(|&column| titled.titles[column].text.clone())
            .collect();
        let listed = titles.join(", ");
        remarks.push(if map.recording.is_none() {
            self.notes = Some(notes_csv(runs, titles));
            format!("kept as notes, no columns of runs.csv: {listed}")
        } else {
            format!("columns of the recording that runs.csv does not take as they are: {listed}")
        });
    }
}

/// Returns the rows of runs or samples: not skipped, no comments.
fn chosen<'a>(
    titled: &'a Titled,
    (map_file, map): (&str, &Map),
    remarks: &mut Vec<String>,
    complaints: &mut Complaints,
) -> Vec<&'a Row> {
    let data_lines: BTreeSet<usize> = titled.data().map(|row| row.line).collect();
    for line in &map.skip {
        if !data_lines.contains(line) {
            let message = format!(
                "skip has {line}, and {} is no row of data",
                titled.table.place(*line)
            );
            complaints.add(Complaint {
                file: map_file.to_owned(),
                message,
                ..Complaint::default()
            });
        }
    }
    let (kept, comments): (Vec<&Row>, Vec<&Row>) = titled
        .data()
        .filter(|row| !map.skip.contains(&row.line))
        .partition(|row| !titled.is_comment(row));
    if !comments.is_empty() {
        remarks.push(format!(
            "comments, left out: lines {}",
            lines(comments.iter().map(|row| row.line))
        ));
    }
    if !map.skip.is_empty() {
        remarks.push(format!(
            "left out, as the map says: {}",
            lines(map.skip.iter().copied())
        ));
    }
    kept
}

/// Returns the numbers of lines in a sentence.
fn lines(numbers: impl Iterator<Item = usize>) -> String {
    numbers
        .map(|line| line.to_string())
        .collect::<Vec<_>>()
        .join(", ")
}

/// Complains about the rows of a text with more or fewer fields than titles.
fn check_width(titled: &Titled, rows: &[&Row], complaints: &mut Complaints) {
    let title_row = titled.table.rows.iter().find(|row| row.line == titled.title_line);
    let width = title_row.map_or(0, |row| row.cells.len());
    for row in rows {
        if let Some(fields) = titled.misfits.get(&row.line) {
            let message = format!(
                "{fields} fields where the titles have {width}: is a decimal comma taken for a separator? Put such fields in quotes, or state `separator` in the map"
            );
            complaints.add_cell(Complaint {
                line: Some(row.line),
                ..titled.table.complaint(message)
            });
        }
    }
}

/// The columns that runs.csv needs and the map lacks.
fn complain_of_missing(
    titled: &Titled,
    (map_file, map): (&str, &Map),
    fields: &[Field],
    complaints: &mut Complaints,
) {
    let has = |name: &str| map.columns.iter().any(|entry| entry.name == name);
    for field in fields
        .iter()
        .filter(|field| field.is_needed && !has(&field.name) && !complaints.concerns(&field.name))
        .collect::<Vec<_>>()
    {
        let near = titled
            .titles
            .iter()
            .find(|title| field.titles.iter().any(|name| *name == title.name.to_lowercase()));
        let fix = near.map_or_else(
            || format!("add `[columns.{}]` with column, value or formula", field.name),
            |near| {
                format!(
                    "did you mean `[columns.{}]` with `column = \"{}\"`",
                    field.name, near.text
                )
            },
        );
        complaints.add(Complaint {
            file: map_file.to_owned(),
            field: Some(field.name.clone()),
            message: format!("the map has no {}, which every run needs: {fix}", field.words),
            ..Complaint::default()
        });
    }
    let channels = shared::channel::Channel::ALL.map(|channel| channel.column());
    if !channels.iter().any(|name| has(name) || complaints.concerns(name)) {
        complaints.add(Complaint {
            file: map_file.to_owned(),
            message: format!(
                "the map has no measured channel: at least one of {} is needed",
                channels.join(", ")
            ),
            ..Complaint::default()
        });
    }
}
