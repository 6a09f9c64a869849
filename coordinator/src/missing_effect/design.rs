//! The design of an experiment: its levels, and the runs that the rig could make next.

use shared::channel::Channel;
use shared::experiment::{TestRun, rim_speed_m_s};
use shared::model::RunCondition;
use statistics::Likelihood;

use job::{PLATE, Spec};

/// Values closer than this share of their range are one level `[1]`.
const SAME_LEVEL: f64 = 0.02;
/// Least levels of a variable for the cross-validation: fewer do not determine an extrapolation.
const LEAST_LEVELS: usize = 3;
/// Slips of proposed runs.
const SLIPS: [f64; 7] = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8];
/// Slip of a braked run, proposed where the rig has made one.
const BRAKED: f64 = -0.2;
/// Factor beyond the measured loads and rim speeds, and the number of each: a rig reaches further than one experiment.
const BEYOND: f64 = 2.0;
const LOADS: usize = 4;
const SPEEDS: usize = 3;

/// The data of each level of slip, wheel load and rim speed, of the variables with enough levels.
pub(super) fn levels(spec: &Spec) -> Vec<Vec<usize>> {
    let runs: Vec<&TestRun> = spec.fit_runs.iter().map(|&i| &spec.experiment.runs[i]).collect();
    let variables: [fn(&TestRun) -> f64; 3] = [
        |run| run.slip,
        |run| run.wheel_load_n,
        |run| rim_speed_m_s(run.slip, run.sled_speed_m_s),
    ];
    let mut levels = Vec::new();
    for variable in variables {
        let values: Vec<f64> = runs.iter().map(|run| variable(run)).collect();
        let own = level_of(&values);
        let count = own.iter().max().map_or(0, |most| most + 1);
        if count >= LEAST_LEVELS {
            levels.extend((0..count).map(|level| of_runs(&spec.likelihood, |run| own[run] == level)));
        }
    }
    levels
}

/// The wheel data of some runs.
fn of_runs(likelihood: &Likelihood, is_in: impl Fn(usize) -> bool) -> Vec<usize> {
    let data = likelihood.data().iter().enumerate();
    data.filter(|(_, d)| d.channel < PLATE && is_in(d.run))
        .map(|(i, _)| i)
        .collect()
}

/// The level of each value, ascending from 0.
fn level_of(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
        return Vec::new();
    };
    let gap = SAME_LEVEL * (values[last] - values[first]);
    let mut level = vec![0; values.len()];
    for pair in order.windows(2) {
        let is_next = values[pair[1]] - values[pair[0]] > gap;
        level[pair[1]] = level[pair[0]] + usize::from(is_next);
    }
    level
}

/// Runs that the rig could make, with wheel and soil of the first fitted run: each slip at each load and rim speed.
pub(super) fn proposed(spec: &Spec) -> Vec<RunCondition> {
    let conditions = &spec.fit_variant.conditions;
    let Some(first) = conditions.first() else {
        return Vec::new();
    };
    let spread = |values: Vec<f64>, count: usize| -> Vec<f64> {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min) / BEYOND;
        let greatest = values.iter().copied().fold(0.0, f64::max) * BEYOND;
        let share = |k: usize| k as f64 / (count - 1) as f64;
        (0..count)
            .map(|k| two_digits(least * libm::pow(greatest / least, share(k))))
            .collect()
    };
    let loads = spread(conditions.iter().map(|c| c.wheel_load_n).collect(), LOADS);
    let rims = conditions.iter().map(|c| rim_speed_m_s(c.slip, c.sled_speed_m_s));
    let rims: Vec<f64> = rims.filter(|speed| *speed > 0.0).collect();
    if rims.is_empty() {
        return Vec::new();
    }
    let rims = spread(rims, SPEEDS);
    let braked = conditions.iter().any(|c| c.slip < -0.05);
    let mut proposed = Vec::new();
    for slip in SLIPS.into_iter().chain(braked.then_some(BRAKED)) {
        for &wheel_load_n in &loads {
            for &rim in &rims {
                let sled_speed_m_s = two_digits(if slip < 0.0 {
                    rim / (1.0 + slip)
                } else {
                    rim * (1.0 - slip)
                });
                proposed.push(RunCondition {
                    slip,
                    wheel_load_n,
                    sled_speed_m_s,
                    slip_angle_deg: 0.0,
                    pass: 1,
                    ..first.clone()
                });
            }
        }
    }
    proposed
}

/// The measured channels with the mean noise sd of each.
pub(super) fn channels(spec: &Spec, theta: &[f64]) -> Vec<(Channel, f64)> {
    let data = spec.likelihood.data();
    let of = |channel: &Channel| {
        let own = data.iter().filter(|d| d.channel == channel.index());
        let sds: Vec<f64> = own
            .filter_map(|d| match d.sd {
                statistics::ErrorSd::Known(sd) => Some(sd),
                statistics::ErrorSd::Inferred { parameter } => theta.get(parameter).copied(),
            })
            .collect();
        inference::diagnostics::mean(&sds).map(|sd| (*channel, sd))
    };
    Channel::ALL.iter().filter_map(of).collect()
}

/// Rounded to two digits, as set on a rig.
fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_within_a_level_makes_no_further_one() {
        assert_eq!(level_of(&[0.6, 0.2, 0.201, 0.4, 0.599]), [2, 0, 0, 1, 2]);
        assert_eq!(level_of(&[5.0, 5.0]), [0, 0]);
        assert!(level_of(&[]).is_empty());
    }
}
