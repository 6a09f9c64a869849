//! The design of an experiment: its levels, and the runs that the rig could make next.

use shared::channel::Channel;
use shared::experiment::{TestRun, rim_speed_m_s};
use shared::model::RunCondition;
use statistics::Likelihood;

use job::{Spec, is_of_run, levels_of};

/// Minimum number of levels of a variable for the cross-validation: fewer do not support an extrapolation.
const MIN_LEVELS: usize = 3;
/// Slips of proposed runs.
const SLIPS: [f64; 7] = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8];
/// Slip of a braked run, proposed if the rig has made one.
const BRAKED: f64 = -0.2;
/// Ratio of the largest proposed load or rim speed to the median of the campaign, and of the median to the smallest; the measured
/// range is proposed in any case.
const REACH: f64 = 2.0;
/// Number of loads, and of rim speeds.
const LEVELS: usize = 3;

/// Returns the data of each level of slip, wheel load and rim speed, of the variables with enough levels.
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
        let level_of_run = levels_of(&values);
        let count = level_of_run.iter().max().map_or(0, |max| max + 1);
        if count >= MIN_LEVELS {
            levels
                .extend((0..count).map(|level| of_runs(&spec.likelihood, |run| level_of_run[run] == level)));
        }
    }
    levels
}

/// Returns the data of each condition of the fitted runs.
pub(super) fn conditions(spec: &Spec) -> Vec<Vec<usize>> {
    let conditions = job::conditions(&spec.experiment, &spec.fit_runs).into_iter();
    conditions
        .map(|runs| of_runs(&spec.likelihood, |run| runs.contains(&run)))
        .collect()
}

/// Returns the wheel data of some runs.
fn of_runs(likelihood: &Likelihood, is_in: impl Fn(usize) -> bool) -> Vec<usize> {
    let data = likelihood.data().iter().enumerate();
    data.filter(|(_, d)| is_of_run(d.channel) && is_in(d.run))
        .map(|(i, _)| i)
        .collect()
}

/// Returns the measured wheel loads, and the rim speeds above 0.
fn measured(conditions: &[RunCondition]) -> [Vec<f64>; 2] {
    let rims = conditions.iter().map(|c| rim_speed_m_s(c.slip, c.sled_speed_m_s));
    [
        conditions.iter().map(|c| c.wheel_load_n).collect(),
        rims.filter(|speed| *speed > 0.0).collect(),
    ]
}

/// Returns the smallest and the largest of some values.
fn range(values: &[f64]) -> [f64; 2] {
    [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(0.0, f64::max),
    ]
}

/// Returns values that the rig can set, equal ratios apart. Their range follows the median, so that it does not grow when a run
/// at its end is added to the campaign. It ends where the rig does, if that is stated.
fn reach(values: &[f64], limits: Option<[f64; 2]>) -> Vec<f64> {
    let mut ascending = values.to_vec();
    ascending.sort_by(f64::total_cmp);
    let median = ascending[ascending.len() / 2];
    let [least, greatest] = range(values);
    let (least, greatest) = (least.min(median / REACH), greatest.max(median * REACH));
    let within = |value: f64| limits.map_or(value, |[low, high]| value.min(high).max(low));
    let (least, greatest) = (within(least), within(greatest));
    let share = |k: usize| k as f64 / (LEVELS - 1) as f64;
    let level = |k: usize| within(two_digits(least * libm::pow(greatest / least, share(k))));
    let mut levels: Vec<f64> = (0..LEVELS).map(level).collect();
    // Within narrow limits levels coincide; the same run is proposed once.
    levels.dedup();
    levels
}

/// Returns how far each run lies beyond the measured range of wheel load and rim speed: the logarithm of the ratio, 0 within the
/// range.
pub(super) fn beyond(spec: &Spec, design: &[RunCondition]) -> Vec<f64> {
    let ranges = measured(&spec.fit_variant.conditions).map(|values| range(&values));
    let of_run = |condition: &RunCondition| {
        let values = [
            condition.wheel_load_n,
            rim_speed_m_s(condition.slip, condition.sled_speed_m_s),
        ];
        let beyond = values
            .iter()
            .zip(&ranges)
            .map(|(x, [least, greatest])| libm::log((least / x).max(x / greatest).max(1.0)));
        beyond.fold(0.0, f64::max)
    };
    design.iter().map(of_run).collect()
}

/// Lists the runs that the rig could make, with wheel and soil of the first fitted run: each slip at each load and rim speed, within the
/// limits that the experiment states.
pub(super) fn proposed(spec: &Spec) -> Vec<RunCondition> {
    let conditions = &spec.fit_variant.conditions;
    let Some(first) = conditions.first() else {
        return Vec::new();
    };
    let [loads, rims] = measured(conditions);
    if rims.is_empty() {
        return Vec::new();
    }
    let rig = &spec.experiment.rig;
    let (loads, rims) = (reach(&loads, rig.wheel_load_range_n), reach(&rims, None));
    let is_within = |range: Option<[f64; 2]>, value: f64| {
        range.is_none_or(|[least, greatest]| (least..=greatest).contains(&value))
    };
    let braked = conditions.iter().any(|c| c.slip < -0.05);
    let mut proposed = Vec::new();
    let slips = SLIPS.into_iter().chain(braked.then_some(BRAKED));
    for slip in slips.filter(|&slip| is_within(rig.slip_range, slip)) {
        for &wheel_load_n in &loads {
            for &rim in &rims {
                let sled_speed_m_s = two_digits(if slip < 0.0 {
                    rim / (1.0 + slip)
                } else {
                    rim * (1.0 - slip)
                });
                if !is_within(rig.sled_speed_range_m_s, sled_speed_m_s) {
                    continue;
                }
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

/// Returns the measured channels with the mean noise sd of each.
pub(super) fn channels(spec: &Spec, theta: &[f64]) -> Vec<(Channel, f64)> {
    let data = spec.likelihood.data();
    let with_sd = |channel: &Channel| {
        let data = data.iter().filter(|d| d.channel == channel.index());
        let sds: Vec<f64> = data
            .filter_map(|d| match d.sd {
                statistics::ErrorSd::Known(sd) => Some(sd),
                statistics::ErrorSd::Inferred { parameter } => theta.get(parameter).copied(),
            })
            .collect();
        inference::diagnostics::mean(&sds).map(|sd| (*channel, sd))
    };
    Channel::ALL.iter().filter_map(with_sd).collect()
}

/// Rounds to two digits, to which a rig is set.
fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reach_does_not_grow_with_a_run_at_its_end() {
        let campaign = [90.0; 6];
        let reach = |values: &[f64]| super::reach(values, None);
        assert_eq!(reach(&campaign), [45.0, 90.0, 180.0]);
        assert_eq!(
            reach(&[&campaign[..], &[180.0, 45.0]].concat()),
            [45.0, 90.0, 180.0]
        );
        // What has been measured is within reach.
        assert_eq!(reach(&[10.0, 100.0, 100.0, 400.0]), [10.0, 63.0, 400.0]);
    }

    #[test]
    fn what_is_proposed_stays_within_the_limits_that_the_rig_states() {
        assert_eq!(reach(&[90.0; 6], Some([50.0, 120.0])), [50.0, 77.0, 120.0]);
        assert_eq!(reach(&[90.0; 6], Some([90.0, 90.0])), [90.0]);
        assert_eq!(reach(&[90.0; 6], Some([90.0, 91.0])), [90.0, 91.0]);
        let (job, mut files, _) = crate::fixture::read("examples/hidden-effect");
        let of = |files: &shared::file::FileSet| proposed(&crate::fixture::spec_of(&job, files).unwrap());
        let free = of(&files);
        files.toml += "\n[rig]\nslip_range = [0.1, 0.5]\nwheel_load_range_n = [40.0, 100.0]\nsled_speed_range_m_s = [0.0, 0.02]\n";
        let bound = of(&files);
        let fits = |run: &RunCondition| {
            (0.1..=0.5).contains(&run.slip)
                && (40.0..=100.0).contains(&run.wheel_load_n)
                && run.sled_speed_m_s <= 0.02
        };
        assert!(free.iter().any(|run| !fits(run)));
        assert!(!bound.is_empty() && bound.iter().all(fits), "{bound:?}");
    }

    #[test]
    fn a_run_lies_beyond_what_was_measured_by_the_greater_of_its_ratios() {
        let (job, files, _) = crate::fixture::read("examples/hidden-effect");
        let spec = crate::fixture::spec_of(&job, &files).unwrap();
        let [loads, rims] = measured(&spec.fit_variant.conditions).map(|values| range(&values));
        let run = |load: f64, rim: f64| RunCondition {
            slip: 0.2,
            wheel_load_n: load,
            sled_speed_m_s: 0.8 * rim,
            ..spec.fit_variant.conditions[0].clone()
        };
        let runs = [
            run(loads[0], rims[1]),
            run(2.0 * loads[1], rims[0]),
            run(2.0 * loads[1], rims[0] / 3.0),
        ];
        let found = beyond(&spec, &runs);
        for (own, ratio) in found.iter().zip([1.0, 2.0, 3.0]) {
            assert!((own - libm::log(ratio)).abs() < 1e-12, "{found:?}");
        }
    }
}
