//! The part of a history in which the wheel sinks to its steady state.

use super::history::MeasuredHistory;
use super::runs::TestRun;
use super::wheel::WheelGeometry;
use crate::channel::Channel;

/// Travel at which the sinkage of a transient is a datum, over the length of the contact.
///
/// Errors of nearer points repeat one another, and behind them the wheel has the steady sinkage but for a few percent, whose average is
/// a datum itself.
const DATA_CONTACT_LENGTHS: [f64; 2] = [0.5, 1.5];
/// Number of equal steps of travel at which a recording is compared with the model.
const TRACK_STEPS: usize = 25;

/// The recorded sinkage of a run from the beginning of its slip to the part that is averaged.
#[derive(Debug, Clone, PartialEq)]
pub struct Transient {
    /// Sinkage at the beginning of the slip `[m]`.
    pub start_sinkage_m: f64,
    /// Mean sinkage of the averaged part `[m]`, > 0.
    pub steady_sinkage_m: f64,
    /// Length of the contact ahead of the axle in the averaged part, `√(2 R z)` of the mean sinkage z `[m]`, > 0.
    pub contact_m: f64,
    /// Travel since the beginning of the slip, ascending from 0 `[m]`.
    travel_m: Vec<f64>,
    /// Sinkage there `[m]`.
    sinkage_m: Vec<f64>,
    /// Travel since the beginning of the slip at which the averaged part begins `[m]`.
    averaged_from_m: f64,
}

impl Transient {
    /// Returns the transient of a run; `None` without a recorded sinkage, where the averaged part is not deeper than the surface, and
    /// where slip begins behind it.
    pub fn new(run: &TestRun, wheel: &WheelGeometry, slip_begins_m: f64) -> Option<Self> {
        let history = run.history.as_ref()?;
        let recorded = history.channel(Channel::Sinkage)?;
        if recorded.average <= 0.0 {
            return None;
        }
        let averaged_from_m = history.travel_at(history.transient_s) - slip_begins_m;
        let samples = history.travel_m.iter().zip(&recorded.filtered);
        let behind = samples.filter(|(travel, _)| **travel > slip_begins_m);
        let start_sinkage_m = interpolated(&history.travel_m, &recorded.filtered, slip_begins_m);
        let behind = behind.map(|(travel, z)| (travel - slip_begins_m, *z));
        let (travel_m, sinkage_m) = std::iter::once((0.0, start_sinkage_m)).chain(behind).unzip();
        let transient = Transient {
            start_sinkage_m,
            steady_sinkage_m: recorded.average,
            contact_m: (2.0 * wheel.radius_m * recorded.average).sqrt(),
            travel_m,
            sinkage_m,
            averaged_from_m,
        };
        (averaged_from_m > transient.contact_m).then_some(transient)
    }

    /// Returns the travel and the sinkage at the points that are data `[m]`: 0.5 and 1.5 lengths of the contact behind the beginning of the
    /// slip, without those closer than one length to the averaged part.
    pub fn data(&self) -> Vec<[f64; 2]> {
        let last_m = self.averaged_from_m - self.contact_m;
        let points = DATA_CONTACT_LENGTHS.map(|lengths| lengths * self.contact_m);
        let points = points.into_iter().take_while(|travel_m| *travel_m <= last_m);
        points
            .map(|travel_m| [travel_m, self.sinkage_at(travel_m)])
            .collect()
    }

    /// Returns the travel and the sinkage at equal steps from the beginning of the slip to the averaged part `[m]`, by which a model is
    /// judged.
    pub fn track(&self) -> Vec<[f64; 2]> {
        let travel_m = |k: usize| self.averaged_from_m * k as f64 / TRACK_STEPS as f64;
        let points = (1..=TRACK_STEPS).map(travel_m);
        points
            .map(|travel_m| [travel_m, self.sinkage_at(travel_m)])
            .collect()
    }

    fn sinkage_at(&self, travel_m: f64) -> f64 {
        interpolated(&self.travel_m, &self.sinkage_m, travel_m)
    }
}

impl MeasuredHistory {
    /// Returns the travel of the sled at a time since the start of the recording `[m]`.
    fn travel_at(&self, time_s: f64) -> f64 {
        interpolated(&self.since_start_s(), &self.travel_m, time_s)
    }

    /// Returns the time since the start of the recording at which the sled has travelled so far `[s]`; that of its first or last sample
    /// beyond them.
    pub fn time_at(&self, travel_m: f64) -> f64 {
        interpolated(&self.travel_m, &self.since_start_s(), travel_m)
    }

    fn since_start_s(&self) -> Vec<f64> {
        let start_s = self.t_s.first().map_or(0.0, |first| first - self.interval_s);
        self.t_s.iter().map(|t| t - start_s).collect()
    }
}

/// Returns a value by linear interpolation over ascending places; the first or last value beyond them.
fn interpolated(places: &[f64], values: &[f64], place: f64) -> f64 {
    let after = places.partition_point(|x| *x < place);
    match (after.checked_sub(1), after < places.len()) {
        (None, _) => values.first().copied().unwrap_or(f64::NAN),
        (Some(last), false) => values[last],
        (Some(before), true) => {
            let share = (place - places[before]) / (places[after] - places[before]);
            values[before] + share * (values[after] - values[before])
        }
    }
}
