//! The join of files on time: columns of one file at the times of another.

use std::collections::BTreeMap;

use crate::complaint::Complaint;
use crate::files::Beside;
use crate::map::{Entry, Join, Map, Origin};
use crate::reading::Reader;
use crate::run::shown;
use crate::series::{Series, usual_step};
use crate::table::Cell;
use crate::title::Titled;
use crate::unit::{self, Quantity};
use crate::zero;

/// Maximum number of cells that files add to a recording.
const MAX_CELLS: usize = 5_000_000;

/// The times of a recording's rows of data `[s]`; `None` for a row that is left out or has no time.
type Times = Vec<Option<f64>>;

/// Adds the columns of the joined files that entries name to a recording, at its times, and lets the entries name the added columns.
///
/// A value is the mean of the straight lines between the samples of the joined file, over the time that lies nearest to the row; it is blank
/// where the joined file has no samples, or a gap of more than five of its steps. Returns the mistakes. Checked by `tests/raw.rs`.
pub(crate) fn join(
    titled: &mut Titled,
    map: &mut Map,
    beside: &mut Beside<'_, '_>,
    remarks: &mut Vec<String>,
) -> Vec<Complaint> {
    let stated = map.clone();
    let is_used = |join: &&Join| {
        stated
            .entries()
            .any(|entry| entry.from.as_ref() == Some(&join.name))
    };
    let joins: Vec<&Join> = stated.joins.iter().filter(is_used).collect();
    if joins.is_empty() {
        return Vec::new();
    }
    let times = match times_of(titled, &stated) {
        Ok(times) => times,
        Err(complaint) => return vec![*complaint],
    };
    let mut complaints = Vec::new();
    for join in joins {
        let added = beside.with(&join.file, &join.layout, |other, beside| {
            add((titled, other), (map, &stated), (join, &times), beside, remarks)
        });
        complaints.extend(added.err().map(|complaint| Complaint {
            field: complaint.field.clone().or(Some("recording".into())),
            message: format!("[join.{}]: {}", join.name, complaint.message),
            ..*complaint
        }));
    }
    complaints
}

/// Returns the times of a recording.
fn times_of(titled: &Titled, map: &Map) -> Result<Times, Box<Complaint>> {
    let Some(recording) = &map.recording else {
        return Err(titled
            .table
            .refusal("files are joined on time: the map needs [recording] with its time"));
    };
    let column = titled.column(&recording.time);
    let unit = unit::read(&recording.time_unit, Quantity::Time);
    let (Ok(column), Ok(unit)) = (column, unit) else {
        // The recording complains about both.
        return Ok(Vec::new());
    };
    let numbers = Reader::new(titled, map, map.layout.decimal, true)?.numbers(column)?;
    let times: Times = numbers.into_iter().map(|t| t.map(|t| t * unit.si)).collect();
    ascending(titled, times.iter().flatten().copied())?;
    Ok(times)
}

/// Refuses times that do not ascend.
fn ascending(titled: &Titled, mut t_s: impl Iterator<Item = f64>) -> Result<(), Box<Complaint>> {
    let mut last = f64::NEG_INFINITY;
    match t_s.find(|t| *t <= std::mem::replace(&mut last, *t)) {
        Some(t) => Err(titled.table.refusal(format!(
            "its times do not ascend at {} s, and files can only be joined on times that do",
            shown(t)
        ))),
        None => Ok(()),
    }
}

/// Adds the columns of one file.
fn add(
    (titled, other): (&mut Titled, &Titled),
    (map, stated): (&mut Map, &Map),
    (join, times): (&Join, &Times),
    beside: &mut Beside<'_, '_>,
    remarks: &mut Vec<String>,
) -> Result<(), Box<Complaint>> {
    let refusal = |message| other.table.refusal(message);
    let time = other.column(&join.time).map_err(refusal)?;
    let seconds = unit::read(&join.time_unit, Quantity::Time).map_err(refusal)?.si;
    let t_s = Reader::new(other, stated, join.layout.decimal, false)?.numbers(time)?;
    let (Some(first), Some(begin)) = (times.iter().flatten().next(), t_s.iter().flatten().next()) else {
        return Err(refusal("it or the recording has no time".into()));
    };
    // Both clocks run alike; they may begin apart.
    let shift_s = join.offset_s
        + if join.is_from_start {
            first - begin * seconds
        } else {
            0.0
        };
    let t_s: Vec<Option<f64>> = t_s.iter().map(|t| t.map(|t| t * seconds + shift_s)).collect();
    ascending(other, t_s.iter().flatten().copied())?;
    let intervals = intervals(times);
    let mut columns: BTreeMap<usize, Vec<Option<f64>>> = BTreeMap::new();
    let is_of_it = |entry: &&mut Entry| entry.from.as_ref() == Some(&join.name);
    let mut taken = vec![time];
    for entry in map.entries_mut().filter(is_of_it) {
        let of_entry = |complaint: Box<Complaint>| {
            Box::new(Complaint {
                field: Some(entry.name.clone()),
                ..*complaint
            })
        };
        let title = entry.column().unwrap_or_default();
        let column = other.column(title).map_err(refusal).map_err(of_entry)?;
        let at_rest =
            zero::reading_at_rest(other, entry, (stated, &join.layout), beside).map_err(of_entry)?;
        if !columns.contains_key(&column) {
            if (columns.len() + 1) * titled.data().count() > MAX_CELLS {
                return Err(refusal(format!(
                    "it adds more than {MAX_CELLS} cells to the recording: join files of fewer rows"
                )));
            }
            let decimal = entry.decimal.or(join.layout.decimal);
            let numbers = Reader::new(other, stated, decimal, false)?.numbers(column)?;
            columns.insert(column, at_times(&t_s, &numbers, &intervals, times));
            taken.push(column);
        }
        entry.reading_at_rest = at_rest;
        entry.origin = Origin::Column(added_title(join, other, column));
        entry.from = None;
    }
    let outside = columns.values().map(|values| {
        let rows = times.iter().zip(values);
        rows.filter(|(t, value)| t.is_some() && value.is_none()).count()
    });
    let outside = outside.max().unwrap_or(0);
    let rows = times.iter().flatten().count();
    if outside == rows {
        let ends = |times: &Times| {
            let mut known = times.iter().flatten();
            let first = known.next().copied().unwrap_or_default();
            (first, known.next_back().copied().unwrap_or(first))
        };
        let ((a, b), (c, d)) = (ends(times), ends(&t_s));
        return Err(refusal(format!(
            "its times, {} to {} s, have no samples at those of {}, {} to {} s: state offset_s, or from_start = true where both begin at once",
            shown(c),
            shown(d),
            titled.table.file,
            shown(a),
            shown(b)
        )));
    }
    if outside > 0 {
        remarks.push(format!(
            "{outside} of {rows} rows have no values of [join.{}]: it has no samples at their times",
            join.name
        ));
    }
    let rest: Vec<&str> = (0..other.titles.len())
        .filter(|column| !taken.contains(column))
        .map(|column| other.titles[column].text.as_str())
        .collect();
    if !rest.is_empty() {
        remarks.push(format!(
            "columns of [join.{}] that no entry takes: {}",
            join.name,
            rest.join(", ")
        ));
    }
    for (column, values) in columns {
        let mut title = other.titles[column].clone();
        title.text = added_title(join, other, column);
        let cell = |value: Option<f64>| value.map_or(Cell::Blank, Cell::Number);
        titled.add_column(title, values.into_iter().map(cell));
    }
    Ok(())
}

/// Returns the title of an added column.
fn added_title(join: &Join, other: &Titled, column: usize) -> String {
    format!("{}: {}", join.name, other.titles[column].text)
}

/// Returns the time that lies nearest to each row: from the middle before it to the middle after it, at the ends from or to the row itself.
fn intervals(times: &Times) -> Vec<(f64, f64)> {
    let known: Vec<f64> = times.iter().flatten().copied().collect();
    let middle = |k: usize| match (known.get(k.wrapping_sub(1)), known.get(k)) {
        (Some(before), Some(after)) => (before + after) / 2.0,
        (Some(end), None) | (None, Some(end)) => *end,
        (None, None) => 0.0,
    };
    (0..known.len()).map(|k| (middle(k), middle(k + 1))).collect()
}

/// Returns the means of a joined column at the rows of a recording.
fn at_times(
    t_s: &Times,
    numbers: &[Option<f64>],
    intervals: &[(f64, f64)],
    times: &Times,
) -> Vec<Option<f64>> {
    let samples = t_s.iter().zip(numbers);
    let samples: Vec<(f64, f64)> = samples
        .filter_map(|(t, number)| Some(((*t)?, (*number)?)))
        .collect();
    let own: Vec<f64> = samples.iter().map(|sample| sample.0).collect();
    let (Some(step_s), Some(first), Some(last)) = (usual_step(&own), own.first(), own.last()) else {
        return vec![None; times.len()];
    };
    let (first, last) = (*first, *last);
    // A row within the samples whose interval leaves them has the mean of the part within.
    let within = intervals
        .iter()
        .zip(times.iter().flatten())
        .map(|(&(from, to), &t)| {
            if (first..=last).contains(&t) {
                (from.max(first), to.min(last))
            } else {
                (from, to)
            }
        });
    let mut means = Series::new(samples, step_s).means(within).into_iter();
    let mean = |t: &Option<f64>| t.and_then(|_| means.next().flatten());
    times.iter().map(mean).collect()
}
