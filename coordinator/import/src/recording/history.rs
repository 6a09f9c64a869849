//! The history of a run: its channels at equal steps.

use super::knife::{Knife, Segment};
use crate::binding::Output;
use crate::complaint::Complaints;
use crate::run::{csv, shown};
use crate::series::{Series, usual_step};

/// Largest deviation of a step of time from the first, as a share of it; equal to that of a history.
pub(super) const UNEVEN: f64 = 0.01;
/// Minimum number of samples of a history.
const MIN_SAMPLES: usize = 3;

/// The steps of a history that a recording did not have.
pub(super) struct Resampled {
    pub(super) shortest_s: f64,
    pub(super) longest_s: f64,
    pub(super) step_s: f64,
}

impl Knife<'_> {
    /// Returns the history of a run: each time is the end of its interval, counted from the run's beginning.
    ///
    /// Steps that differ by more than 1 % become equal: each value is the mean over its step of the straight lines between the samples.
    pub(super) fn history(
        &self,
        segment: &Segment<'_>,
        channels: &[&Output],
        complaints: &mut Complaints,
    ) -> Option<(String, Option<Resampled>)> {
        let samples = &segment.samples;
        let first = samples.first()?;
        let t_s: Vec<f64> = samples.iter().map(|sample| sample.t_s).collect();
        let steps = || t_s.windows(2).map(|pair| pair[1] - pair[0]);
        let (shortest_s, longest_s) = steps().fold((f64::INFINITY, 0.0_f64), |(shortest, longest), step| {
            (shortest.min(step), longest.max(step))
        });
        if samples.len() < MIN_SAMPLES || shortest_s <= 0.0 {
            let message = format!(
                "run \"{}\": {} samples are too few for a history: at least {MIN_SAMPLES}",
                segment.name,
                samples.len()
            );
            if samples.len() < MIN_SAMPLES {
                self.complain_at(first.row, message, complaints);
            }
            // Times that do not ascend have a complaint already.
            return None;
        }
        let begun = t_s.get(1)? - first.t_s;
        let is_even = steps().all(|step| (step - begun).abs() <= UNEVEN * begun);
        if is_even && self.recording.step_s.is_none() {
            return Some((self.as_recorded(segment, channels, begun, complaints), None));
        }
        let usual = usual_step(&t_s)?;
        let step_s = self.recording.step_s.unwrap_or(usual);
        if step_s < usual * (1.0 - UNEVEN) {
            let message = format!(
                "run \"{}\": step_s {step_s} s must be at least {} s, the usual step of the recording",
                segment.name,
                shown(usual)
            );
            self.complain_at(first.row, message, complaints);
            return None;
        }
        let text = self.resampled(segment, channels, step_s, complaints)?;
        let resampled = Resampled {
            shortest_s,
            longest_s,
            step_s,
        };
        Some((text, Some(resampled)))
    }

    /// Returns the text of a history at the steps of the recording.
    fn as_recorded(
        &self,
        segment: &Segment<'_>,
        channels: &[&Output],
        step_s: f64,
        complaints: &mut Complaints,
    ) -> String {
        let mut rows = vec![header(channels)];
        let first_s = segment.samples.first().map_or(0.0, |sample| sample.t_s);
        for sample in &segment.samples {
            let mut row = vec![shown(sample.t_s - first_s + step_s)];
            for output in channels {
                let value = self.binding.value(output, &sample.numbers);
                if value.is_none() {
                    self.complain_of_gap(output, sample.row, complaints);
                }
                row.push(value.map(shown).unwrap_or_default());
            }
            rows.push(row);
        }
        csv(rows.into_iter())
    }

    /// Returns the text of a history at equal steps, or `None` with a complaint.
    fn resampled(
        &self,
        segment: &Segment<'_>,
        channels: &[&Output],
        step_s: f64,
        complaints: &mut Complaints,
    ) -> Option<String> {
        let (first, last) = (segment.samples.first()?, segment.samples.last()?);
        // The last step may be short by the rounding of its end.
        let steps = ((last.t_s - first.t_s) / step_s + UNEVEN).floor() as usize;
        let end = |k: usize| (first.t_s + k as f64 * step_s).min(last.t_s);
        let mut rows: Vec<Vec<String>> = vec![header(channels)];
        rows.extend((1..=steps).map(|k| vec![shown(k as f64 * step_s)]));
        let mut is_whole = true;
        for output in channels {
            let known = segment.samples.iter().filter_map(|sample| {
                let value = self.binding.value(output, &sample.numbers)?;
                Some((sample.t_s, value))
            });
            let series = Series::new(known.collect(), step_s);
            let means = series.means((0..steps).map(|k| (end(k), end(k + 1))));
            if let Some(k) = means.iter().position(Option::is_none) {
                let message = format!(
                    "run \"{}\": {} has no values between {} and {} s that lie at most five steps of {} s apart: a longer step_s bridges more",
                    segment.name,
                    output.field.words,
                    shown(end(k)),
                    shown(end(k + 1)),
                    shown(step_s)
                );
                let row = segment.samples.iter().find(|sample| sample.t_s >= end(k));
                self.complain_at(row.unwrap_or(first).row, message, complaints);
                is_whole = false;
            }
            for (row, mean) in rows.iter_mut().skip(1).zip(means) {
                row.push(mean.map(shown).unwrap_or_default());
            }
        }
        is_whole.then(|| csv(rows.into_iter()))
    }
}

fn header(channels: &[&Output]) -> Vec<String> {
    let names = channels.iter().map(|output| output.field.name.clone());
    std::iter::once("t_s".to_owned()).chain(names).collect()
}
