//! The rows of each run: those of a marker, those where a condition holds, or the whole file.

use std::collections::{BTreeMap, BTreeSet};

use super::knife::{Knife, Sample, Segment};
use crate::binding::Above;
use crate::complaint::{Complaint, Complaints};
use crate::map::Mark;
use crate::number::{self, Decimal, Writing};
use crate::table::{Cell, Row};
use crate::unit::{self, Quantity};

/// Column of the time, with its unit in seconds.
type Time = (usize, f64);

impl<'a> Knife<'a> {
    /// Returns the runs of a recording; none if its columns are not there.
    pub(super) fn segments(
        &self,
        rows: &[&'a Row],
        remarks: &mut Vec<String>,
        complaints: &mut Complaints,
    ) -> Vec<Segment<'a>> {
        let time = self.time(complaints);
        let (mut segments, between, what) = match &self.recording.mark {
            Mark::Column { name, between } => {
                let marker = self.marker(name, complaints);
                let (Some(time), Some(marker)) = (time, marker) else {
                    return Vec::new();
                };
                let (segments, between) = self.marked(rows, time, (marker, between), complaints);
                (segments, between, "marker")
            }
            Mark::Condition { shortest_s, .. } => {
                let Some(time) = time else {
                    return Vec::new();
                };
                let samples = self.samples(rows, time, complaints);
                let all = samples.len();
                let segments = self.where_it_holds(samples, *shortest_s);
                let within: usize = segments.iter().map(|segment| segment.samples.len()).sum();
                (segments, all - within, "condition")
            }
            Mark::File => {
                let Some(time) = time else {
                    return Vec::new();
                };
                let segment = Segment {
                    name: self.file_run.to_owned(),
                    samples: self.samples(rows, time, complaints),
                };
                (vec![segment], 0, "file")
            }
        };
        segments.retain(|segment| !segment.samples.is_empty());
        if segments.is_empty() {
            let message = match what {
                "file" => "there is no row of data below the titles".to_owned(),
                what => format!("the {what} never marks a run"),
            };
            complaints.add(self.titled.table.complaint(message));
        }
        if between > 0 {
            remarks.push(format!(
                "{between} of {} rows lie between runs and are left out",
                rows.len()
            ));
        }
        number_repeated(&mut segments, what, remarks);
        if self.is_one_of_several && what == "marker" {
            for segment in &mut segments {
                segment.name = format!("{}-{}", self.file_run, segment.name);
            }
        }
        segments
    }

    fn time(&self, complaints: &mut Complaints) -> Option<Time> {
        let time = self.titled.column(&self.recording.time);
        let unit = unit::read(&self.recording.time_unit, Quantity::Time);
        for message in [time.as_ref().err(), unit.as_ref().err()].into_iter().flatten() {
            self.complain(complaints, message);
        }
        Some((time.ok()?, unit.ok()?.si))
    }

    fn marker(&self, name: &str, complaints: &mut Complaints) -> Option<usize> {
        let mut names = self.binding.outputs.iter().map(|output| &output.field.name);
        if names.any(|name| name == "run") {
            self.complain(complaints, "the marker names the runs: leave [columns.run] out");
        }
        let marker = self.titled.column(name);
        marker.map_err(|message| self.complain(complaints, &message)).ok()
    }

    /// Returns a row with its time and numbers; `None` if the time cannot be read.
    fn sample(
        &self,
        row: &'a Row,
        (time, seconds): Time,
        above: &mut Above,
        complaints: &mut Complaints,
    ) -> Option<Sample<'a>> {
        let writing = Writing {
            decimal: self.decimal.unwrap_or(Decimal::Point),
            has_thousands: false,
        };
        let t = match row.cell(time) {
            Cell::Number(value) => Ok(*value),
            Cell::Text(text) => number::read(text, writing),
            Cell::Blank | Cell::NoResult => Err("the time is blank".into()),
        };
        match t {
            Ok(t) => Some(Sample {
                row,
                t_s: t * seconds,
                numbers: self.binding.numbers(self.titled, row, above, complaints),
            }),
            Err(message) => {
                complaints.add_cell(Complaint {
                    field: Some("recording".into()),
                    ..self.titled.table.complaint_at(row.line, time, message)
                });
                None
            }
        }
    }

    fn samples(&self, rows: &[&'a Row], time: Time, complaints: &mut Complaints) -> Vec<Sample<'a>> {
        let mut above = Above::default();
        let sample = |row: &&'a Row| self.sample(row, time, &mut above, complaints);
        rows.iter().filter_map(sample).collect()
    }

    /// Returns the runs of a marker, and the number of rows between them.
    fn marked(
        &self,
        rows: &[&'a Row],
        time: Time,
        (marker, between): (usize, &BTreeSet<String>),
        complaints: &mut Complaints,
    ) -> (Vec<Segment<'a>>, usize) {
        let mut above = Above::default();
        let mut segments: Vec<Segment<'a>> = Vec::new();
        let (mut last, mut left_out) = (None, 0);
        for &row in rows {
            let mark = row.cell(marker).shown();
            let is_same = last.as_ref() == Some(&mark);
            last = Some(mark.clone());
            if mark.is_empty() || between.contains(&mark) {
                left_out += 1;
                continue;
            }
            let Some(sample) = self.sample(row, time, &mut above, complaints) else {
                continue;
            };
            match segments.last_mut().filter(|_| is_same) {
                Some(segment) => segment.samples.push(sample),
                None => segments.push(Segment {
                    name: mark,
                    samples: vec![sample],
                }),
            }
        }
        (segments, left_out)
    }

    /// Returns the runs of a condition: interruptions shorter than `shortest_s` are bridged, then shorter runs are left out.
    fn where_it_holds(&self, samples: Vec<Sample<'a>>, shortest_s: f64) -> Vec<Segment<'a>> {
        let mut stretches: Vec<(usize, usize)> = Vec::new();
        for (place, sample) in samples.iter().enumerate() {
            if !self.binding.is_within_a_run(&sample.numbers) {
                continue;
            }
            let is_near = |end: usize| end + 1 == place || sample.t_s - samples[end].t_s < shortest_s;
            match stretches.last_mut().filter(|(_, end)| is_near(*end)) {
                Some((_, end)) => *end = place,
                None => stretches.push((place, place)),
            }
        }
        stretches.retain(|(begin, end)| samples[*end].t_s - samples[*begin].t_s >= shortest_s);
        let mut samples = samples.into_iter();
        let mut at = 0;
        let segment = |(begin, end): (usize, usize)| {
            let run = samples.by_ref().skip(begin - at).take(end + 1 - begin);
            at = end + 1;
            Segment {
                name: self.file_run.to_owned(),
                samples: run.collect(),
            }
        };
        stretches.into_iter().map(segment).collect()
    }
}

/// Runs of the same name are numbered, because a marker may only switch between on and off.
fn number_repeated(segments: &mut [Segment<'_>], what: &str, remarks: &mut Vec<String>) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for segment in segments.iter() {
        *counts.entry(segment.name.clone()).or_default() += 1;
    }
    counts.retain(|_, count| *count > 1);
    for (name, count) in &counts {
        let comes = match what {
            "condition" => format!("the condition holds {count} times"),
            what => format!("the {what} \"{name}\" comes {count} times"),
        };
        remarks.push(format!("{comes}: its runs are named {name}-1 to {name}-{count}"));
    }
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for segment in segments {
        if counts.contains_key(&segment.name) {
            let number = numbers.entry(segment.name.clone()).or_default();
            *number += 1;
            segment.name = format!("{}-{number}", segment.name);
        }
    }
}
