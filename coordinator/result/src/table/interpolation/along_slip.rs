//! Interpolation in slip between runs that differ in slip only, by a monotone cubic.

use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse, TestRun};

use crate::table::conditions::ALIKE_LOADS;

/// Difference of slips below which runs repeat one condition.
const SAME_SLIP: f64 = 0.02;

/// Interpolates at the slip of a run by a monotone cubic between the fitted runs of the same wheel, soil, slip angle, speed and pass,
/// whose loads are within a factor of 1.5; `None` outside their range.
pub(super) fn along_slip(experiment: &Experiment, run: &TestRun, channel: Channel) -> Option<f64> {
    let near = |a: f64, b: f64, factor: f64| a / b < factor && b / a < factor;
    let alike = |other: &&TestRun| {
        other.usage == RunUse::Fit
            && other.wheel == run.wheel
            && other.soil == run.soil
            && other.pass == run.pass
            && (other.slip_angle_deg - run.slip_angle_deg).abs() < 0.5
            && near(other.sled_speed_m_s, run.sled_speed_m_s, 1.05)
            && near(other.wheel_load_n, run.wheel_load_n, ALIKE_LOADS)
    };
    let runs = experiment.runs.iter().filter(alike);
    let mut points: Vec<(f64, f64)> = runs
        .filter_map(|r| Some((r.slip, r.measured[channel.index()]?)))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    monotone_cubic(&averaged(&points), run.slip)
}

/// Averages points whose slip differs little from the first of their group.
fn averaged(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut groups: Vec<(f64, Vec<(f64, f64)>)> = Vec::new();
    for &point in points {
        match groups.last_mut() {
            Some((first, group)) if point.0 - *first <= SAME_SLIP => group.push(point),
            _ => groups.push((point.0, vec![point])),
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    groups
        .into_iter()
        .map(|(_, group)| {
            let (x, y): (Vec<f64>, Vec<f64>) = group.into_iter().unzip();
            (mean(&x), mean(&y))
        })
        .collect()
}

/// Interpolates by a cubic Hermite polynomial whose slopes keep it monotone between points.
///
/// Fritsch and Butland 1984, SIAM J. Sci. Stat. Comput. 5:300: harmonic means of the neighbouring slopes.
fn monotone_cubic(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let right = points.iter().position(|p| p.0 >= x)?;
    if right == 0 {
        // A value at the first point is not extrapolated; a value before it would be.
        return (points[0].0 - x < SAME_SLIP).then_some(points[0].1);
    }
    let secant = |i: usize| (points[i + 1].1 - points[i].1) / (points[i + 1].0 - points[i].0);
    let slope = |i: usize| {
        if i == 0 || i + 1 == points.len() {
            return secant(if i == 0 { 0 } else { i - 1 });
        }
        let (before, after) = (secant(i - 1), secant(i));
        if before * after <= 0.0 {
            0.0
        } else {
            2.0 * before * after / (before + after)
        }
    };
    let left = right - 1;
    let width = points[right].0 - points[left].0;
    let t = (x - points[left].0) / width;
    let (t2, t3) = (t * t, t * t * t);
    Some(
        (2.0 * t3 - 3.0 * t2 + 1.0) * points[left].1
            + (t3 - 2.0 * t2 + t) * width * slope(left)
            + (3.0 * t2 - 2.0 * t3) * points[right].1
            + (t3 - t2) * width * slope(right),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_is_kept_and_nothing_is_extrapolated() {
        let line = [(0.0, 1.0), (1.0, 3.0), (3.0, 7.0)];
        assert!((monotone_cubic(&line, 2.0).unwrap() - 5.0).abs() < 1e-12);
        assert_eq!(monotone_cubic(&line, 3.5), None);
        assert_eq!(monotone_cubic(&line, -0.5), None);
    }

    #[test]
    fn no_overshoot_beside_a_step() {
        let step = [(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 1.0)];
        for k in 0..=30 {
            let y = monotone_cubic(&step, 0.1 * f64::from(k)).unwrap();
            assert!((-1e-12..=1.0 + 1e-12).contains(&y), "{y}");
        }
    }

    #[test]
    fn repeats_are_averaged() {
        let points = averaged(&[(0.2, 1.0), (0.201, 3.0), (0.5, 4.0)]);
        assert_eq!(points.len(), 2);
        assert!((points[0].1 - 2.0).abs() < 1e-12);
    }
}
