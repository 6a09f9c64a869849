//! Runs cut from one long recording, where a marker changes.

use std::collections::BTreeMap;

use shared::channel::Channel;

use crate::binding::{Above, Binding, Output, is_text};
use crate::complaint::{Complaint, Complaints};
use crate::map::Recording;
use crate::number::{self, Decimal, Writing};
use crate::rule;
use crate::run::{Run, csv, shown};
use crate::table::{Cell, Row};
use crate::title::Titled;
use crate::unit::{self, Quantity};

/// Largest deviation of a step of time from the first, as a share of it; equal to that of a history.
const UNEVEN: f64 = 0.01;
/// Minimum number of samples of a history.
const MIN_SAMPLES: usize = 3;

/// The runs of a recording, and the texts of their histories by file name.
pub(crate) type Cut = (Vec<Run>, BTreeMap<String, String>);

struct Sample<'a> {
    row: &'a Row,
    t_s: f64,
    numbers: Vec<Option<f64>>,
}

/// The rows between two changes of the marker.
struct Segment<'a> {
    name: String,
    samples: Vec<Sample<'a>>,
}

/// The data of a cut.
pub(crate) struct Knife<'a> {
    pub(crate) titled: &'a Titled,
    pub(crate) binding: &'a Binding,
    pub(crate) recording: &'a Recording,
    pub(crate) map_file: &'a str,
    pub(crate) decimal: Option<Decimal>,
    /// Prefix of the names of histories.
    pub(crate) stem: &'a str,
}

impl Knife<'_> {
    pub(crate) fn cut(&self, rows: &[&Row], remarks: &mut Vec<String>, complaints: &mut Complaints) -> Cut {
        let Some((time, seconds, marker)) = self.columns(complaints) else {
            return Cut::default();
        };
        let segments = self.segments(rows, (time, seconds), marker, remarks, complaints);
        if segments.is_empty() {
            complaints.add(self.titled.table.complaint("the marker never marks a run"));
        }
        let (mut runs, mut histories) = Cut::default();
        for segment in &segments {
            let run = self.run(segment, &mut histories, complaints);
            runs.push(run);
        }
        (runs, histories)
    }

    fn complain(&self, complaints: &mut Complaints, message: String) {
        complaints.add(Complaint {
            file: self.map_file.to_owned(),
            line: Some(self.recording.line),
            field: Some("recording".into()),
            message: format!("[recording]: {message}"),
            ..Complaint::default()
        });
    }

    /// Returns the columns of time and marker, and the time's unit in seconds.
    fn columns(&self, complaints: &mut Complaints) -> Option<(usize, f64, usize)> {
        let time = self.titled.column(&self.recording.time);
        let marker = self.titled.column(&self.recording.marker);
        let unit = unit::read(&self.recording.time_unit, Quantity::Time);
        if self
            .binding
            .outputs
            .iter()
            .any(|output| output.field.name == "run")
        {
            self.complain(
                complaints,
                "the marker names the runs: leave [columns.run] out".into(),
            );
        }
        for message in [time.as_ref().err(), unit.as_ref().err(), marker.as_ref().err()]
            .into_iter()
            .flatten()
        {
            self.complain(complaints, message.clone());
        }
        Some((time.ok()?, unit.ok()?.si, marker.ok()?))
    }

    fn segments<'a>(
        &self,
        rows: &[&'a Row],
        (time, seconds): (usize, f64),
        marker: usize,
        remarks: &mut Vec<String>,
        complaints: &mut Complaints,
    ) -> Vec<Segment<'a>> {
        let writing = Writing {
            decimal: self.decimal.unwrap_or(Decimal::Point),
            has_thousands: false,
        };
        let mut above = Above::default();
        let mut segments: Vec<Segment<'a>> = Vec::new();
        let (mut last, mut between) = (None, 0);
        for &row in rows {
            let mark = row.cell(marker).shown();
            let is_same = last.as_ref() == Some(&mark);
            last = Some(mark.clone());
            if mark.is_empty() || self.recording.between.contains(&mark) {
                between += 1;
                continue;
            }
            let t = match row.cell(time) {
                Cell::Number(value) => Ok(*value),
                Cell::Text(text) => number::read(text, writing),
                Cell::Blank | Cell::NoResult => Err("the time is blank".into()),
            };
            let t_s = match t {
                Ok(t) => t * seconds,
                Err(message) => {
                    let field = Some("recording".into());
                    complaints.add_cell(Complaint {
                        field,
                        ..self.titled.table.complaint_at(row.line, time, message)
                    });
                    continue;
                }
            };
            let numbers = self.binding.numbers(self.titled, row, &mut above, complaints);
            let sample = Sample { row, t_s, numbers };
            match segments.last_mut().filter(|_| is_same) {
                Some(segment) => segment.samples.push(sample),
                None => segments.push(Segment {
                    name: mark,
                    samples: vec![sample],
                }),
            }
        }
        if between > 0 {
            remarks.push(format!(
                "{between} of {} rows lie between runs and are left out",
                rows.len()
            ));
        }
        number_repeated(&mut segments, remarks);
        segments
    }

    /// Returns the samples of a segment whose time lies in the window.
    fn window<'a, 'b>(&self, segment: &'b Segment<'a>, complaints: &mut Complaints) -> &'b [Sample<'a>] {
        let samples = segment.samples.as_slice();
        let (Some((from, to)), [first, .., last]) = (self.recording.window_s, samples) else {
            return samples;
        };
        let length = last.t_s - first.t_s;
        if to > length * (1.0 + UNEVEN) {
            let message = format!(
                "run \"{}\" lasts {length:.6} s, and window_s ends at {to} s",
                segment.name
            );
            complaints.add_cell(Complaint {
                field: Some("recording".into()),
                line: Some(first.row.line),
                ..self.titled.table.complaint(message)
            });
        }
        let begin = samples.partition_point(|sample| sample.t_s - first.t_s < from);
        let end = samples.partition_point(|sample| sample.t_s - first.t_s <= to);
        samples
            .get(begin..end)
            .filter(|chosen| !chosen.is_empty())
            .unwrap_or(samples)
    }

    fn run(
        &self,
        segment: &Segment<'_>,
        histories: &mut BTreeMap<String, String>,
        complaints: &mut Complaints,
    ) -> Run {
        let Some(first) = segment.samples.first() else {
            return Run::default();
        };
        self.check_times(segment, complaints);
        let chosen = self.window(segment, complaints);
        let mut run = Run {
            line: first.row.line,
            name: segment.name.clone(),
            ..Run::default()
        };
        let means = means(chosen);
        let (mut kept, channels): (Vec<&Output>, Vec<&Output>) = self
            .binding
            .outputs
            .iter()
            .partition(|output| !(self.recording.histories && is_channel(output)));
        kept.retain(|output| output.field.name != "run");
        for output in kept {
            match self.cell(output, chosen, &means, complaints) {
                Some(Ok(text)) => {
                    run.cells.insert(output.field.name.clone(), text);
                }
                Some(Err(message)) => complaints.add_cell(self.binding.complaint(
                    self.titled,
                    first.row,
                    output,
                    format!("run \"{}\": {message}", run.name),
                )),
                None if output.field.is_needed => {
                    let message = format!("run \"{}\": {} is blank", run.name, output.field.words);
                    complaints.add_cell(self.binding.complaint(self.titled, first.row, output, message));
                }
                None => {}
            }
        }
        if self.recording.histories
            && let Some(text) = self.history(segment, &channels, complaints)
        {
            let file = self.free_name(&run.name, histories);
            run.cells.insert("history".into(), file.clone());
            histories.insert(file, text);
        }
        run
    }

    /// Complains about the first time that does not lie after the one before.
    fn check_times(&self, segment: &Segment<'_>, complaints: &mut Complaints) {
        let mut pairs = segment.samples.windows(2);
        if let Some(pair) = pairs.find(|pair| pair[1].t_s <= pair[0].t_s) {
            let message = format!(
                "the time {} s must lie after {} s",
                shown(pair[1].t_s),
                shown(pair[0].t_s)
            );
            complaints.add_cell(Complaint {
                line: Some(pair[1].row.line),
                field: Some("recording".into()),
                ..self.titled.table.complaint(message)
            });
        }
    }

    /// Returns the text of a run's cell, or a message; `None` if it is blank.
    fn cell(
        &self,
        output: &Output,
        samples: &[Sample<'_>],
        means: &[Option<f64>],
        complaints: &mut Complaints,
    ) -> Option<Result<String, String>> {
        if is_text(output) {
            return self.constant(output, samples, complaints);
        }
        // Measured values are averaged; formulas of conditions are computed from the averages of these.
        let value = if is_channel(output) {
            self.mean(output, samples)
        } else {
            self.binding.value(output, means)
        };
        value.map(|value| rule::check_number(&output.field, value).map(|()| shown(value)))
    }

    /// Returns the text if it is equal in all samples.
    fn constant(
        &self,
        output: &Output,
        samples: &[Sample<'_>],
        complaints: &mut Complaints,
    ) -> Option<Result<String, String>> {
        let mut above = Above::default();
        let mut common: Option<String> = None;
        for sample in samples {
            let text = self.binding.text(output, sample.row, &mut above);
            match (&common, text) {
                (None, text) => common = text,
                (Some(common), Some(text)) if *common != text => {
                    let message = format!(
                        "{} changes from \"{common}\" to \"{text}\" within a run",
                        output.field.words
                    );
                    complaints.add_cell(self.binding.complaint(self.titled, sample.row, output, message));
                    break;
                }
                _ => {}
            }
        }
        common.map(|text| rule::check_text(&output.field, &text))
    }

    fn mean(&self, output: &Output, samples: &[Sample<'_>]) -> Option<f64> {
        let values: Vec<f64> = samples
            .iter()
            .filter_map(|sample| self.binding.value(output, &sample.numbers))
            .collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Returns the history of a run: each time is the end of its interval, counted from the run's beginning.
    fn history(
        &self,
        segment: &Segment<'_>,
        channels: &[&Output],
        complaints: &mut Complaints,
    ) -> Option<String> {
        let samples = &segment.samples;
        let first = samples.first()?;
        if samples.len() < MIN_SAMPLES {
            let message = format!(
                "{} samples are too few for a history: at least {MIN_SAMPLES}",
                samples.len()
            );
            self.complain_of_run(segment, first.row, &message, complaints);
        }
        let step = samples.get(1)?.t_s - first.t_s;
        let uneven = samples
            .windows(2)
            .find(|pair| (pair[1].t_s - pair[0].t_s - step).abs() > UNEVEN * step);
        if let Some(pair) = uneven {
            let message = format!(
                "the time {} s comes {:.6} s after the one before, the first two are {step:.6} s apart: a history needs equal steps",
                shown(pair[1].t_s),
                pair[1].t_s - pair[0].t_s
            );
            self.complain_of_run(segment, pair[1].row, &message, complaints);
        }
        let header = std::iter::once("t_s".to_owned())
            .chain(channels.iter().map(|output| output.field.name.clone()))
            .collect();
        let mut rows = vec![header];
        for sample in samples {
            let mut row = vec![shown(sample.t_s - first.t_s + step)];
            for output in channels {
                let value = self.binding.value(output, &sample.numbers);
                if value.is_none() {
                    self.complain_of_gap(output, sample.row, complaints);
                }
                row.push(value.map(shown).unwrap_or_default());
            }
            rows.push(row);
        }
        Some(csv(rows.into_iter()))
    }

    fn complain_of_run(&self, segment: &Segment<'_>, row: &Row, message: &str, complaints: &mut Complaints) {
        let message = format!("run \"{}\": {message}", segment.name);
        complaints.add_cell(Complaint {
            line: Some(row.line),
            field: Some("recording".into()),
            ..self.titled.table.complaint(message)
        });
    }

    fn complain_of_gap(&self, output: &Output, row: &Row, complaints: &mut Complaints) {
        if !complaints.is_said(row.line, &output.field.name) {
            let message = format!(
                "{} is blank within a run, and a history has no gaps",
                output.field.words
            );
            complaints.add_cell(self.binding.complaint(self.titled, row, output, message));
        }
    }

    fn free_name(&self, run: &str, used: &BTreeMap<String, String>) -> String {
        let plain: String = run
            .chars()
            .map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' })
            .take(60)
            .collect();
        let names = std::iter::once(String::new()).chain((2..).map(|number| format!("-{number}")));
        let mut names = names.map(|number| format!("{}-{plain}{number}.csv", self.stem));
        names.find(|name| !used.contains_key(name)).unwrap_or_default()
    }
}

/// Runs whose marker recurs are numbered, because a marker may only switch between on and off.
fn number_repeated(segments: &mut [Segment<'_>], remarks: &mut Vec<String>) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for segment in segments.iter() {
        *counts.entry(segment.name.clone()).or_default() += 1;
    }
    counts.retain(|_, count| *count > 1);
    for (name, count) in &counts {
        remarks.push(format!(
            "the marker \"{name}\" comes {count} times: its runs are named {name}-1 to {name}-{count}"
        ));
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

fn is_channel(output: &Output) -> bool {
    Channel::ALL
        .iter()
        .any(|channel| channel.column() == output.field.name)
}

fn means(samples: &[Sample<'_>]) -> Vec<Option<f64>> {
    let width = samples.first().map_or(0, |sample| sample.numbers.len());
    let mean = |input: usize| {
        let values: Vec<f64> = samples
            .iter()
            .filter_map(|sample| sample.numbers.get(input).copied().flatten())
            .collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    (0..width).map(mean).collect()
}
