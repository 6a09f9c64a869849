//! The balance of moments about the axle, which torque, pull, load, sinkage and radius must fit in any soil.
//!
//! The force of the soil on a wheel acts on the rim ahead of the axle, at an angle θ that drawbar pull F, torque T and wheel load W
//! determine without a model of the soil: θ = asin(T / (R √(F² + W²))) − atan(F / W). The rim touches the soil up to the angle
//! θ₁ = acos(1 − z / R) of its sinkage z. In a correct table, θ is a nearly constant share of θ₁ in all runs: within .01 to .05 rad
//! (rms) in synthetic experiments of many soils, with or without a hidden effect, and in measured ones.

use shared::channel::Channel;
use shared::experiment::{Experiment, TestRun, WheelGeometry};

/// Minimum number of runs that are judged.
const MIN_RUNS: usize = 5;
/// Slip angle up to which the force along the heading is that of a wheel that rolls straight ahead `[deg]`.
const STRAIGHT_DEG: f64 = 15.0;

/// The measurements of a run that the balance connects.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading<'a> {
    pub(super) wheel: &'a str,
    pub(super) radius_m: f64,
    pub(super) tip_radius_m: f64,
    pub(super) load_n: f64,
    pub(super) pull_n: f64,
    pub(super) torque_n_m: f64,
    pub(super) sinkage_m: f64,
}

/// How well the readings fit each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Misfit {
    /// The angle of the soil's force as a share of the contact angle, common to all readings, in [0, 1].
    pub(super) share: f64,
    /// The root mean square deviation from this share `[rad]`.
    pub(super) residual_rad: f64,
}

/// The readings of an experiment.
#[derive(Debug)]
pub(super) struct MomentBalance<'a> {
    pub(super) readings: Vec<Reading<'a>>,
}

impl<'a> Reading<'a> {
    /// Returns the reading of a straight run that measured pull, torque and a sinkage below the surface.
    fn new(run: &'a TestRun, wheel: &WheelGeometry) -> Option<Self> {
        let measured = |channel: Channel| run.measured[channel.index()];
        let sinkage_m = measured(Channel::Sinkage).filter(|sinkage_m| *sinkage_m > 0.0)?;
        let reading = Reading {
            wheel: &run.wheel,
            radius_m: wheel.radius_m,
            tip_radius_m: wheel.radius_m + wheel.grouser_height_m,
            load_n: run.wheel_load_n,
            pull_n: measured(Channel::DrawbarPull)?,
            torque_n_m: measured(Channel::Torque)?,
            sinkage_m,
        };
        (run.slip_angle_deg.abs() <= STRAIGHT_DEG).then_some(reading)
    }

    /// Returns the angle of the soil's force and the contact angle `[rad]`. A torque that no force on the rim can exert counts as the
    /// largest that one can, and a wheel below the surface as one that touches the soil all around.
    fn angles(&self) -> [f64; 2] {
        let force_n = libm::hypot(self.pull_n, self.load_n);
        let arm = (self.torque_n_m / (self.radius_m * force_n)).clamp(-1.0, 1.0);
        let contact = libm::acos((1.0 - self.sinkage_m / self.radius_m).max(-1.0));
        [libm::asin(arm) - libm::atan2(self.pull_n, self.load_n), contact]
    }
}

impl<'a> MomentBalance<'a> {
    /// Returns the balance of an experiment; `None` with too few complete runs.
    pub(super) fn new(experiment: &'a Experiment) -> Option<Self> {
        let runs = experiment.runs.iter();
        let readings = runs.filter_map(|run| Reading::new(run, &experiment.wheels[&run.wheel]));
        let readings: Vec<Reading> = readings.collect();
        (readings.len() >= MIN_RUNS).then_some(MomentBalance { readings })
    }

    /// Returns the names of the wheels, without repetition, in the order of their first runs.
    pub(super) fn wheels(&self) -> Vec<&'a str> {
        let mut wheels = Vec::new();
        for reading in &self.readings {
            if !wheels.contains(&reading.wheel) {
                wheels.push(reading.wheel);
            }
        }
        wheels
    }

    /// Returns the mean of a quantity of the readings.
    pub(super) fn mean(&self, quantity: impl Fn(&Reading) -> f64) -> f64 {
        self.readings.iter().map(quantity).sum::<f64>() / self.readings.len() as f64
    }

    /// Returns the misfit of the table as it stands, for the rims or for the tips of the grousers, whichever fit better.
    pub(super) fn stated(&self) -> Misfit {
        let rims = self.corrected(|reading| reading);
        let tips = self.corrected(|reading| Reading {
            radius_m: reading.tip_radius_m,
            ..reading
        });
        match tips.residual_rad < rims.residual_rad {
            true => tips,
            false => rims,
        }
    }

    /// Returns the misfit after a correction of every reading.
    pub(super) fn corrected(&self, correct: impl Fn(Reading<'a>) -> Reading<'a>) -> Misfit {
        let angles: Vec<[f64; 2]> = self.readings.iter().map(|r| correct(*r).angles()).collect();
        let product: f64 = angles.iter().map(|[force, contact]| force * contact).sum();
        let square: f64 = angles.iter().map(|[_, contact]| contact * contact).sum();
        // The soil pushes where it touches: neither behind the axle nor beyond the contact.
        let share = (product / square).clamp(0.0, 1.0);
        let squares = angles.iter().map(|[force, contact]| force - share * contact);
        let sum: f64 = squares.map(|deviation| deviation * deviation).sum();
        let residual_rad = libm::sqrt(sum / angles.len() as f64);
        Misfit { share, residual_rad }
    }
}
