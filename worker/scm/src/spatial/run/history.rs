//! Time histories of a run.

/// Time histories of a run, one entry for each step of equal length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// Time of a step `[s]`; the first entry is the wheel lowered onto the soil, before it travels.
    pub step_s: f64,
    /// Drawbar pull `[N]`.
    pub drawbar_pull_n: Vec<f64>,
    /// Torque \[N m\].
    pub torque_n_m: Vec<f64>,
    /// Sinkage `[m]`.
    pub sinkage_m: Vec<f64>,
    /// Lateral force `[N]`; > 0: against the sideways motion of a positive slip angle.
    pub lateral_force_n: Vec<f64>,
    /// Vertical force of the soil on the wheel `[N]`.
    pub wheel_load_n: Vec<f64>,
}

impl History {
    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.sinkage_m.len()
    }

    /// Returns the sinkage after a number of steps `[m]`, by linear interpolation; `None` beyond the last.
    pub fn sinkage_at(&self, steps: f64) -> Option<f64> {
        let before = steps.max(0.0).floor();
        let (here, next) = (before as usize, self.sinkage_m.get(before as usize + 1));
        let next = *next?;
        Some(self.sinkage_m[here] + (steps.max(0.0) - before) * (next - self.sinkage_m[here]))
    }

    /// Returns whether there is no step yet.
    pub fn is_empty(&self) -> bool {
        self.sinkage_m.is_empty()
    }

    /// Returns the channels in the order drawbar pull, torque, sinkage, lateral force, wheel load.
    pub fn channels(&self) -> [&[f64]; 5] {
        [
            &self.drawbar_pull_n,
            &self.torque_n_m,
            &self.sinkage_m,
            &self.lateral_force_n,
            &self.wheel_load_n,
        ]
    }
}
