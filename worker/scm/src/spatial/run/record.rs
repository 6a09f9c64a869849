//! Record of the steps of a run, and its averages.

use super::history::History;
use super::result::SpatialRun;
use super::rolling::{Rolling, Step};
use crate::rejection::Rejection;
use crate::{Averages, Condition};
use signal::{Window, period_mean};

/// Number of steps between measurements of the contour; not a divisor of a column's steps, because the contour depends on
/// the phase within a column.
const CONTOUR_EVERY: usize = 13;
/// Tolerated power from the soil, relative to the power through the wheel and to load times speed.
///
/// It results from the residual of the balance and, on hard ground, from springs under grousers, whose force acts along the
/// spoke while their depth is measured downwards (0.2 % of load times speed).
const ENERGY_TOLERANCE: f64 = 5e-3;
/// Largest mean residual of the vertical balance, relative to the wheel load, over the averaged steps and over the run;
/// balanced steps contribute up to 0.0065.
const MAX_RESIDUAL: f64 = 0.025;

/// Means of drawbar pull, torque, sinkage and lateral force, and the steps over which the diagnostics are averaged.
pub(super) struct Windows {
    pub(super) means: [f64; 4],
    pub(super) first_step: usize,
}

/// The results of a run, step by step.
pub(super) struct Record {
    pub(super) history: History,
    /// Drawbar pull, torque, sinkage and lateral force by the soil's forces, if the measured channels differ.
    soil_channels: [Vec<f64>; 4],
    contact_length_m: Vec<f64>,
    /// Sum of the contact lengths `[m]`.
    contact_lengths: f64,
    b_eff_m: Vec<f64>,
    nodes: Vec<f64>,
    residual_n: Vec<f64>,
    /// Sum of the residuals since the wheel was lowered, and its maximum, in loads.
    missed: f64,
    max_missed: f64,
    /// The load to be carried, less the nominal one.
    load_change_n: Vec<f64>,
    /// Power that motor and rig put into the soil `[W]`.
    power_w: Vec<f64>,
}

impl Record {
    /// Creates a record for at most `max_steps` steps.
    pub(super) fn new(step_s: f64, max_steps: usize) -> Self {
        Self {
            history: History {
                step_s,
                ..History::default()
            },
            soil_channels: Default::default(),
            contact_length_m: Vec::new(),
            contact_lengths: 0.0,
            b_eff_m: Vec::new(),
            nodes: Vec::new(),
            residual_n: Vec::new(),
            missed: 0.0,
            max_missed: MAX_RESIDUAL * max_steps as f64,
            load_change_n: Vec::new(),
            power_w: Vec::new(),
        }
    }

    /// Adds the measured channels of a step; power and balance use the soil's channels.
    ///
    /// [`Rejection::NoConvergence`] as soon as the residuals so far make the mean over the run too large, because further
    /// steps without a balance would take long.
    pub(super) fn push(&mut self, rolling: &mut Rolling, step: &Step) -> Result<(), Rejection> {
        let reaction = &step.reaction;
        if self.history.len().is_multiple_of(CONTOUR_EVERY) {
            self.b_eff_m.push(rolling.effective_width());
        }
        let contact_length = reaction.area / rolling.width();
        let (pull, torque, lateral) = (reaction.force_x, reaction.torque, -reaction.force_y);
        let mut channels = [pull, torque, rolling.sinkage(step.hub), lateral];
        let effects = rolling.effects.as_ref();
        if let Some(effects) = effects.filter(|effects| effects.change_channels()) {
            for (soil, value) in self.soil_channels.iter_mut().zip(channels) {
                soil.push(value);
            }
            let b_eff = self.b_eff_m.last().copied().unwrap_or(0.0);
            channels = effects.measure(channels, &rolling.contact, contact_length, b_eff)?;
        }
        self.history.drawbar_pull_n.push(channels[0]);
        self.history.torque_n_m.push(channels[1]);
        self.history.sinkage_m.push(channels[2]);
        self.history.lateral_force_n.push(channels[3]);
        self.history.wheel_load_n.push(reaction.force_z);
        self.contact_length_m.push(contact_length);
        self.contact_lengths += contact_length;
        self.load_change_n.push(step.load - rolling.nominal_load());
        self.nodes.push(f64::from(reaction.nodes));
        self.residual_n.push(step.residual);
        let motion = &rolling.motion;
        self.power_w.push(
            reaction.torque * motion.rotation
                - reaction.force_x * motion.forward
                - reaction.force_y * motion.lateral
                - reaction.force_z * step.rising,
        );
        let steps = self.residual_n.len() - 1;
        if steps > 0 {
            self.missed += step.residual.abs() / step.load;
        }
        if self.missed > self.max_missed {
            return Err(Rejection::NoConvergence {
                residual_load_n: self.missed / steps as f64 * step.load,
                wheel_load_n: step.load,
                sinkage_m: rolling.sinkage(step.hub),
                evaluations: rolling.contact.trials as u32,
            });
        }
        Ok(())
    }

    /// Returns the mean length of the contact so far `[m]`.
    pub(super) fn contact_length(&self) -> f64 {
        self.contact_lengths / self.contact_length_m.len() as f64
    }

    /// Returns whether the measured channels differ from the soil's.
    fn measured_otherwise(&self) -> bool {
        !self.soil_channels[0].is_empty()
    }

    /// Returns the drawbar pull, torque and lateral force of the soil from a step on, if they are measured as `means`.
    fn forces(&self, means: [f64; 4], first: usize) -> [f64; 3] {
        [0, 1, 3].map(|i| {
            let channel = &self.soil_channels[i];
            let part = &channel[first.min(channel.len())..];
            if part.is_empty() {
                means[i]
            } else {
                part.iter().sum::<f64>() / part.len() as f64
            }
        })
    }

    /// Returns the means of the four measured channels, between two places counted in steps of travel.
    pub(super) fn means(&self, from: f64, to: f64) -> Result<[f64; 4], Rejection> {
        let [pull, torque, sinkage, lateral, _] = self.history.channels();
        means([pull, torque, sinkage, lateral], from, to)
    }

    /// Returns the means of the soil's channels: a measurement offset must not decide when a run has settled.
    pub(super) fn soil_means(&self, from: f64, to: f64) -> Result<[f64; 4], Rejection> {
        if !self.measured_otherwise() {
            return self.means(from, to);
        }
        means(self.soil_channels.each_ref().map(Vec::as_slice), from, to)
    }

    pub(super) fn finish(
        self,
        rolling: &Rolling,
        condition: &Condition,
        windows: Windows,
        settled_to: Option<f64>,
    ) -> Result<SpatialRun, Rejection> {
        let mean = |values: &[f64], first: usize| {
            let part = &values[first.min(values.len() - 1)..];
            part.iter().sum::<f64>() / part.len() as f64
        };
        let [drawbar_pull_n, torque_n_m, sinkage_m, lateral_force_n] = windows.means;
        for (quantity, value) in [
            ("drawbar pull", drawbar_pull_n),
            ("torque", torque_n_m),
            ("sinkage", sinkage_m),
            ("lateral force", lateral_force_n),
        ] {
            if !value.is_finite() {
                return Err(Rejection::NotFinite { quantity, value });
            }
        }
        let first = windows.first_step;
        let residuals: Vec<f64> = self.residual_n.iter().map(|r| r.abs()).collect();
        let residual_load_n = mean(&residuals, first);
        // a free hub is in balance with its damper at once, but must come to rest on the soil
        let carried_n = mean(&self.history.wheel_load_n, first);
        let wheel_load_n = condition.wheel_load_n + mean(&self.load_change_n, first);
        let off_load = residual_load_n.max((carried_n - wheel_load_n).abs());
        if off_load > MAX_RESIDUAL * wheel_load_n {
            return Err(Rejection::NoConvergence {
                residual_load_n: off_load,
                wheel_load_n,
                sinkage_m,
                evaluations: rolling.contact.trials as u32,
            });
        }
        let dissipated_power_w = mean(&self.power_w, first);
        let [pull, torque, lateral] = self.forces(windows.means, first);
        let throughput = (torque * rolling.motion.rotation).abs()
            + (pull * rolling.motion.forward).abs()
            + (lateral * rolling.motion.lateral).abs();
        // a wheel with little slip on hard ground has almost no throughput
        let scale = throughput + wheel_load_n * condition.sled_speed_m_s;
        if dissipated_power_w < -ENERGY_TOLERANCE * scale {
            return Err(Rejection::EnergyGained {
                power_w: dissipated_power_w,
                throughput_w: throughput,
            });
        }
        let steps = self.history.len() - 1;
        Ok(SpatialRun {
            averages: Averages {
                drawbar_pull_n,
                torque_n_m,
                sinkage_m,
                lateral_force_n,
                b_eff_m: mean(&self.b_eff_m, first.div_ceil(CONTOUR_EVERY)),
                contact_length_m: mean(&self.contact_length_m, first),
                residual_load_n,
                nodes_in_contact: libm::round(mean(&self.nodes, first)) as u32,
                simulated_travel_m: steps as f64 * rolling.steps.travel,
            },
            settled_to,
            dissipated_power_w,
            trials: rolling.contact.trials,
            node_trials: rolling.contact.node_trials,
            history: self.history,
        })
    }
}

fn means(channels: [&[f64]; 4], from: f64, to: f64) -> Result<[f64; 4], Rejection> {
    let mut means = [0.0; 4];
    for (mean, channel) in means.iter_mut().zip(channels) {
        let history = signal::SampledSignal {
            start_s: 0.0,
            interval_s: 1.0,
            samples: &channel[1..],
        };
        let window = Window {
            from_s: from,
            to_s: to,
            period_s: None,
        };
        *mean = period_mean(&history, &window)?.mean;
    }
    Ok(means)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Active;
    use crate::fixture::CONDITION;
    use crate::spatial::fixture::scene;
    use crate::spatial::{Ground, Grousers, RunSettings, Shape};

    /// Returns the result of finishing a short run after a change of its record.
    fn finished(change: fn(&mut Record)) -> Result<SpatialRun, Rejection> {
        let (ground, shape) = (Ground::default(), Shape::Rim(Grousers::default()));
        let none = Active::default();
        let scene = scene(&ground, &shape, &none);
        let mut rolling = Rolling::new(&scene, &CONDITION, None, RunSettings::default(), 0.05)?;
        let mut record = Record::new(rolling.steps.time, 50);
        let lowered = rolling.lower()?;
        record.push(&mut rolling, &lowered)?;
        for _ in 0..50 {
            let step = rolling.step()?;
            record.push(&mut rolling, &step)?;
        }
        change(&mut record);
        let (means, first_step) = (record.means(20.0, 50.0)?, 20);
        let windows = Windows { means, first_step };
        record.finish(&rolling, &CONDITION, windows, None)
    }

    fn kind(change: fn(&mut Record)) -> &'static str {
        finished(change).map_or_else(|rejection| rejection.kind(), |_| "none")
    }

    #[test]
    fn a_run_that_gains_energy_is_rejected() {
        assert_eq!(kind(|_| ()), "none");
        let reversed = kind(|record| record.power_w.iter_mut().for_each(|p| *p = -*p));
        // 2 % of 100 N that move at 10 mm/s
        let slight = kind(|record| record.power_w.fill(-2e-2));
        assert_eq!([reversed, slight], ["energy_gained"; 2]);
    }

    #[test]
    fn a_run_out_of_balance_is_rejected() {
        // one step in a hundred may miss the whole load, but not one in ten
        assert_eq!(kind(|record| record.residual_n[40] = 50.0), "none");
        assert_eq!(kind(|record| record.residual_n.fill(-3.0)), "no_convergence");
    }

    #[test]
    fn a_mean_that_is_no_number_is_rejected() {
        let kind = kind(|record| record.history.torque_n_m[30] = f64::NAN);
        assert_eq!(kind, "not_finite");
    }
}
