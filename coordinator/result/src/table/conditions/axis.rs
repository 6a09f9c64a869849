//! The conditions of the rig as coordinates.

use job::repeats;
use shared::experiment::{TestRun, rim_speed_m_s};

/// Loads within this factor are alike where a rig does not hold its load.
pub(crate) const ALIKE_LOADS: f64 = 1.5;

/// A condition that may vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    Slip,
    SlipAngle,
    WheelLoad,
    SledSpeed,
    RimSpeed,
}

impl Axis {
    /// Name in sentences.
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

    /// Whether two runs that differed in this condition alone would be repeats.
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

    /// Number of different values.
    pub(crate) fn count(self, runs: &[&TestRun]) -> usize {
        let mut different: Vec<&TestRun> = Vec::new();
        for run in runs {
            if !different.iter().any(|other| self.is_same(other, run)) {
                different.push(run);
            }
        }
        different.len()
    }

    /// Those that tell runs apart: slip, angle, load, and the speed that was set: that of sled or rim, of which there are fewer values.
    pub(super) fn distinguishing(runs: &[&TestRun]) -> [Axis; 4] {
        let speed = match Axis::RimSpeed.count(runs) < Axis::SledSpeed.count(runs) {
            true => Axis::RimSpeed,
            false => Axis::SledSpeed,
        };
        [Axis::Slip, Axis::SlipAngle, Axis::WheelLoad, speed]
    }

    /// Whether the condition was varied. Loads that were set lie apart or span more than [`ALIKE_LOADS`]; those of a rig that does
    /// not hold its load scatter within that without a gap.
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
