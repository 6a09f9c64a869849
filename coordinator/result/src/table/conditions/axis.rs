//! Axis: one condition of the rig as a coordinate, and whether runs vary it.

use job::repeats;
use shared::experiment::{TestRun, rim_speed_m_s};

/// Ratio of loads up to which they count as one condition if the rig cannot hold its load.
pub(crate) const ALIKE_LOADS: f64 = 1.5;

/// A condition of the rig that may vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    Slip,
    SlipAngle,
    WheelLoad,
    SledSpeed,
    RimSpeed,
}

impl Axis {
    /// Returns the name for sentences.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Axis::Slip => "slip",
            Axis::SlipAngle => "slip angle",
            Axis::WheelLoad => "load",
            Axis::SledSpeed => "sled speed",
            Axis::RimSpeed => "rim speed",
        }
    }

    pub(crate) fn value(self, run: &TestRun) -> f64 {
        match self {
            Axis::Slip => run.slip,
            Axis::SlipAngle => run.slip_angle_deg,
            Axis::WheelLoad => run.wheel_load_n,
            Axis::SledSpeed => run.sled_speed_m_s,
            Axis::RimSpeed => rim_speed_m_s(run.slip, run.sled_speed_m_s),
        }
    }

    /// Returns whether two runs would be repeats if they differed in this condition only.
    pub(crate) fn is_same(self, a: &TestRun, b: &TestRun) -> bool {
        let with = |run: &TestRun| {
            let (value, mut only) = (self.value(run), a.clone());
            match self {
                Axis::Slip => only.slip = value,
                Axis::SlipAngle => only.slip_angle_deg = value,
                Axis::WheelLoad => only.wheel_load_n = value,
                Axis::SledSpeed | Axis::RimSpeed => only.sled_speed_m_s = value,
            }
            only
        };
        repeats(&with(a), &with(b))
    }

    /// Counts the different values of the condition.
    pub(crate) fn count(self, runs: &[&TestRun]) -> usize {
        let mut different: Vec<&TestRun> = Vec::new();
        for run in runs {
            if !different.iter().any(|other| self.is_same(other, run)) {
                different.push(run);
            }
        }
        different.len()
    }

    /// Returns the conditions that tell runs apart: slip, slip angle, load, and the speed that was set, which is that of sled or rim,
    /// whichever has fewer values.
    pub(crate) fn distinguishing(runs: &[&TestRun]) -> [Axis; 4] {
        let speed = match Axis::RimSpeed.count(runs) < Axis::SledSpeed.count(runs) {
            true => Axis::RimSpeed,
            false => Axis::SledSpeed,
        };
        [Axis::Slip, Axis::SlipAngle, Axis::WheelLoad, speed]
    }

    /// Returns whether the condition was varied. Loads that were set deliberately have gaps or span more than [`ALIKE_LOADS`]; loads that
    /// a rig cannot hold scatter within that range without a gap.
    pub(crate) fn varies(self, runs: &[&TestRun]) -> bool {
        if self != Axis::WheelLoad {
            return self.count(runs) > 1;
        }
        let mut ordered = runs.to_vec();
        ordered.sort_by(|a, b| self.value(a).total_cmp(&self.value(b)));
        let ends = ordered.first().zip(ordered.last());
        ends.is_some_and(|(least, most)| self.value(most) > ALIKE_LOADS * self.value(least))
            || ordered.windows(2).any(|pair| !self.is_same(pair[0], pair[1]))
    }
}
