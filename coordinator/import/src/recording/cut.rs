//! The runs of a recording, with their averages and histories.

use std::collections::BTreeMap;

use shared::channel::Channel;

use super::history::{Resampled, UNEVEN};
use super::knife::{Knife, Sample, Segment};
use crate::binding::{Above, Output, is_text};
use crate::complaint::{Complaint, Complaints};
use crate::map::Mark;
use crate::rule;
use crate::run::{Run, shown};
use crate::table::Row;

/// Cuts the rows of a recording into runs; adds the texts of their histories by file name.
pub(crate) fn cut(
    knife: &Knife<'_>,
    rows: &[&Row],
    histories: &mut BTreeMap<String, String>,
    remarks: &mut Vec<String>,
    complaints: &mut Complaints,
) -> Vec<Run> {
    let segments = knife.segments(rows, remarks, complaints);
    let mut resampled = Vec::new();
    let run = |segment| knife.run(segment, (histories, &mut resampled), complaints);
    let runs = segments.iter().map(run).collect();
    remarks.extend(remark(&resampled));
    runs
}

/// Returns the remark about steps that became equal.
fn remark(resampled: &[Resampled]) -> Option<String> {
    let shortest_s = resampled.iter().map(|run| run.shortest_s).reduce(f64::min)?;
    let longest_s = resampled.iter().map(|run| run.longest_s).reduce(f64::max)?;
    let step_s = resampled.first()?.step_s;
    Some(format!(
        "steps of {} to {} s become equal steps of {} s, in {} histories",
        shown(shortest_s),
        shown(longest_s),
        shown(step_s),
        resampled.len()
    ))
}

impl Knife<'_> {
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
        (histories, resampled): (&mut BTreeMap<String, String>, &mut Vec<Resampled>),
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
        if matches!(self.recording.mark, Mark::Column { .. }) {
            kept.retain(|output| output.field.name != "run");
        }
        for output in kept {
            match self.cell(output, chosen, &means, complaints) {
                Some(Ok(text)) if output.field.name == "run" => run.name = text,
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
            && let Some((text, steps)) = self.history(segment, &channels, complaints)
        {
            resampled.extend(steps);
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
